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

TEST(CompressedRows, AreMirrored) {
  constexpr std::uint32_t n = 40;
  const auto value = [](std::uint32_t i, std::uint32_t j) { return (7 * i + 13 * j) % 5; }; // 0: no entry
  using Entry = std::pair<std::uint32_t, std::uint32_t>;
  const auto rows = [&](bool whole) {
    return build_rows<Entry>(n, [&](auto&& visit) {
      for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = whole ? 0 : i + 1; j < n; ++j)
          if (const std::uint32_t v = value(std::min(i, j), std::max(i, j)); v > 0 && i != j) visit(i, Entry(j, v));
    });
  };
  for (const unsigned threads : {1u, 3u}) {
    std::vector<std::uint64_t> begin, expected_begin;
    std::vector<std::uint32_t> column, expected_column, entry, expected_entry;
    split_rows(rows(true), expected_begin, expected_column, expected_entry, Threads(threads));
    mirror_rows(rows(false), begin, column, entry, Threads(threads));
    ASSERT_GT(column.size(), n);
    EXPECT_EQ(begin, expected_begin);
    EXPECT_EQ(column, expected_column);
    EXPECT_EQ(entry, expected_entry);
  }
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> column, entry;
  mirror_rows(build_rows<Entry>(0, [](auto&&) {}), begin, column, entry, Threads(1));
  EXPECT_THAT(begin, ElementsAre(0u));
}

} // namespace
} // namespace eigencrust
