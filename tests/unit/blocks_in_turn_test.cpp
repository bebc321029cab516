// SPDX-License-Identifier: GPL-3.0-or-later
#include "blocks_in_turn.h"

#include <gtest/gtest.h>
#include <vector>

namespace eigencrust::cli {
namespace {

struct BlocksInTurnTest : testing::Test {
  std::vector<char> memory = std::vector<char>(1000);
  BlocksInTurn blocks;
  void add(std::size_t begin, std::size_t size) { blocks.add(&memory[begin], size); }
  /// Begin and size of the next part; 0, 0: there is none.
  std::pair<std::size_t, std::size_t> next(std::size_t most) {
    const auto part = blocks.next(most);
    return {part.size == 0 ? 0 : static_cast<std::size_t>(part.begin - memory.data()), part.size};
  }
  using Part = std::pair<std::size_t, std::size_t>;
};

TEST_F(BlocksInTurnTest, GoesThroughAllBlocksAndRoundAgain) {
  EXPECT_EQ(next(40), Part(0, 0));
  add(100, 100);
  add(300, 30);
  for (int round = 0; round < 2; ++round)
    for (const Part& part : {Part(100, 40), Part(140, 40), Part(180, 20), Part(300, 30)}) EXPECT_EQ(next(40), part);
}

TEST_F(BlocksInTurnTest, AKnownBlockIsRemovedWithItsSize) {
  add(100, 100);
  EXPECT_EQ(blocks.remove(&memory[140]), 0u);
  EXPECT_EQ(blocks.remove(&memory[100]), 100u);
  EXPECT_EQ(blocks.remove(&memory[100]), 0u);
  EXPECT_EQ(next(40), Part(0, 0));
}

TEST_F(BlocksInTurnTest, NoPartLeavesABlockThatTookAnothersPlace) {
  // What lies beyond it is somebody else's.
  add(100, 100);
  add(300, 30);
  EXPECT_EQ(next(40), Part(100, 40));
  EXPECT_EQ(next(40), Part(140, 40));
  blocks.remove(&memory[100]);
  add(100, 50);
  EXPECT_EQ(next(40), Part(100, 40));
  EXPECT_EQ(next(40), Part(140, 10));
  EXPECT_EQ(next(40), Part(300, 30));
  blocks.remove(&memory[100]);
  add(100, 200); // a larger one
  EXPECT_EQ(next(150), Part(100, 150));
  EXPECT_EQ(next(150), Part(250, 50));
}

TEST_F(BlocksInTurnTest, GoesOnWhereABlockWent) {
  add(100, 100);
  add(300, 30);
  EXPECT_EQ(next(40), Part(100, 40));
  blocks.remove(&memory[100]);
  EXPECT_EQ(next(40), Part(300, 30));
  blocks.remove(&memory[300]);
  add(500, 10);
  EXPECT_EQ(next(40), Part(500, 10));
}

} // namespace
} // namespace eigencrust::cli
