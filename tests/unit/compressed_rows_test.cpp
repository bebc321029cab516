// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/compressed_rows.h"

#include <gmock/gmock.h>

namespace eigencrust {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(CompressedRows, KeepTheOrderOfTheirEntries) {
  const std::vector<std::pair<std::size_t, int>> entries{{2, 7}, {0, 1}, {2, 5}, {0, 1}};
  const auto rows = build_rows<int>(4, [&](auto&& visit) {
    for (const auto& [row, item] : entries) visit(row, item);
  });
  EXPECT_THAT(rows[0], ElementsAre(1, 1));
  EXPECT_THAT(rows[1], IsEmpty());
  EXPECT_THAT(rows[2], ElementsAre(7, 5));
  EXPECT_THAT(rows[3], IsEmpty());
  EXPECT_THAT(build_rows<int>(0, [](auto&&) {}).begin, ElementsAre(0u));
}

TEST(CompressedRows, AreTheSameForAnyNumberOfThreads) {
  for (const unsigned count : {1u, 3u})
    for (const std::size_t n : {0u, 1u, 10u, 101u}) {
      const auto rows = build_rows<std::size_t>(Threads(count), n, 10, [] {
        return [](std::size_t row, std::vector<std::size_t>& items) { items.insert(items.end(), row % 4, row); };
      });
      ASSERT_EQ(rows.begin.size(), n + 1);
      for (std::size_t row = 0; row < n; ++row) {
        EXPECT_EQ(rows[row].size(), row % 4);
        EXPECT_THAT(rows[row], testing::Each(row));
      }
    }
}

} // namespace
} // namespace eigencrust
