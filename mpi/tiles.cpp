// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>

#include <eigencrust/error.h>
#include <eigencrust/report.h>

#include "geometry/tetrahedron.h"
#include "parallel/threads.h"
#include "tetrahedra/assemble.h"

namespace eigencrust::mpi {
namespace {

// Of smaller tiles most is border.
constexpr std::uint32_t least_samples_of_a_rank = 20000;

/// In words that another rank can throw.
struct Failure {
  ErrorKind kind = ErrorKind::guarantee;
  std::string place, cause, remedy;
};

Failure describe(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& e) {
    return {e.kind(), e.place(), e.cause(), e.remedy()};
  } catch (const std::bad_alloc&) {
    return {ErrorKind::memory, "delaunay", "memory is exhausted", "take more ranks, or machines with more memory"};
  } catch (const std::exception& e) {
    return {ErrorKind::guarantee, "delaunay", e.what(), "report this as a fault of the program"};
  }
}

/// Who fails amid an exchange cannot tell the others, who wait for what it was to send: all end, with its words.
template <class Part>
void or_end_all(const Messages& messages, Part&& part) {
  try {
    part();
  } catch (...) {
    const Failure f = describe(std::current_exception());
    std::fprintf(stderr, "eigencrust: error: %s (rank %d, %s); %s\n", f.cause.c_str(), messages.rank(), f.place.c_str(),
                 f.remedy.c_str());
    messages.abort(static_cast<int>(f.kind));
  }
}

/// What everyone has to know.
struct Frame {
  std::uint32_t samples = 0;
  std::array<Vec3, cube_corners> corners;
};

/// Which blocks each rank has; those at the end may have none.
class Shares {
 public:
  Shares(std::uint32_t samples, std::uint32_t blocks, int ranks)
      : samples_(samples),
        blocks_(blocks),
        sharing_(std::clamp(samples / least_samples_of_a_rank, 1u, static_cast<std::uint32_t>(ranks))) {}

  [[nodiscard]] std::uint32_t first_block(std::size_t rank) const {
    const std::uint64_t before = std::min<std::uint64_t>(rank, sharing_);
    return static_cast<std::uint32_t>(blocks_ * before / sharing_);
  }
  [[nodiscard]] SampleRange samples_of(std::size_t rank) const {
    const auto at = [&](std::uint64_t block) {
      return static_cast<std::uint32_t>(std::min<std::uint64_t>(block * SampleBlocks::block_size, samples_));
    };
    return {at(first_block(rank)), at(first_block(rank + 1))};
  }
  [[nodiscard]] std::size_t rank_of(std::uint32_t block) const {
    std::size_t rank = 0;
    while (block >= first_block(rank + 1)) ++rank;
    return rank;
  }

 private:
  std::uint32_t samples_, blocks_, sharing_;
};

/// How a round ends; the worst of all ranks counts.
enum class Round : std::uint64_t { settled, wanting, given_up, failed };

/// Blocks from the ranks that have them.
class Supply : public SampleSupply {
 public:
  Supply(const Messages& messages, const Shares& shares, SampleBlocks& blocks, TileProgress& progress)
      : messages_(messages), shares_(shares), blocks_(blocks), progress_(progress) {}

  bool fetch(const std::vector<std::uint32_t>& wanted) override {
    const Round here = progress_.given_up() ? Round::given_up : wanted.empty() ? Round::settled : Round::wanting;
    if (agree(here) != Round::wanting) return false;
    ++rounds_;
    or_end_all(messages_, [&] { bring(wanted); });
    return true;
  }

  /// Gives the others what they want, until none wants any more.
  void serve() {
    while (!over_) fetch({});
  }

  [[nodiscard]] std::uint64_t rounds() const { return rounds_; }
  [[nodiscard]] std::uint64_t samples_fetched() const { return samples_fetched_; }

  /// Where this rank failed the others must not wait for it.
  void fail() {
    while (!over_) agree(Round::failed);
  }

 private:
  Round agree(Round here) {
    const auto all = static_cast<Round>(messages_.largest(static_cast<std::uint64_t>(here)));
    over_ = all != Round::wanting;
    if (all >= Round::given_up) progress_.give_up();
    return all;
  }

  void bring(const std::vector<std::uint32_t>& wanted) {
    const auto ranks = static_cast<std::size_t>(messages_.size());
    std::vector<std::vector<std::uint32_t>> asked(ranks);
    for (const std::uint32_t block : wanted) asked[shares_.rank_of(block)].push_back(block);
    const auto asked_here = messages_.exchange(asked);
    std::vector<std::vector<Vec3>> answers(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
      for (const std::uint32_t block : asked_here[r]) {
        const SampleRange range = blocks_.samples_of(block);
        for (std::uint32_t s = range.begin; s < range.end; ++s) answers[r].push_back(blocks_.position(s));
      }
    const auto came = messages_.exchange(answers);
    for (std::size_t r = 0; r < ranks; ++r) {
      std::span<const Vec3> samples(came[r]);
      for (const std::uint32_t block : asked[r]) {
        const std::uint32_t count = blocks_.samples_of(block).size();
        blocks_.learn(block, samples.first(count));
        samples_fetched_ += count;
        samples = samples.subspan(count);
      }
    }
  }

  const Messages& messages_;
  const Shares& shares_;
  SampleBlocks& blocks_;
  TileProgress& progress_;
  bool over_ = false;
  std::uint64_t rounds_ = 0, samples_fetched_ = 0;
};

/// All ranks end if one does, with what the first of them has to say.
void throw_together(const Messages& messages, const std::exception_ptr& thrown) {
  if (messages.sum(thrown ? 1 : 0) == 0) return;
  std::vector<std::vector<char>> said(static_cast<std::size_t>(messages.size()));
  if (thrown) {
    const Failure f = describe(thrown);
    std::string text = std::to_string(static_cast<int>(f.kind));
    for (const std::string& part : {f.place, f.cause, f.remedy}) text += '\n' + part;
    for (auto& to : said) to.assign(text.begin(), text.end());
  }
  const auto heard = messages.exchange(said);
  const auto first = std::find_if(heard.begin(), heard.end(), [](const auto& text) { return !text.empty(); });
  if (thrown && first == heard.begin() + messages.rank()) std::rethrow_exception(thrown);
  std::vector<std::string> parts{{}};
  for (const char c : *first) {
    if (c == '\n')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  parts.resize(4);
  throw Error(static_cast<ErrorKind>(std::stoi(parts[0])),
              "rank " + std::to_string(first - heard.begin()) + ", " + parts[1], parts[2], parts[3]);
}

/// Does this rank's part; after `failed`, where it throws, all ranks throw.
template <class Part, class Failed>
void together(const Messages& messages, Part&& part, Failed&& failed) {
  std::exception_ptr thrown;
  try {
    part();
  } catch (...) {
    thrown = std::current_exception();
    failed();
  }
  throw_together(messages, thrown);
}

Frame frame_of(const Tetrahedralization* enclosed) {
  Frame frame;
  if (enclosed == nullptr) return frame;
  frame.samples = enclosed->sample_count;
  std::ranges::copy(corners_of(*enclosed), frame.corners.begin());
  return frame;
}

/// What all ranks know of all blocks; made on the root.
std::vector<BlockSketch> sketch(const Messages& messages, const Tetrahedralization* enclosed) {
  std::vector<BlockSketch> sketches;
  if (enclosed != nullptr) {
    const SampleBlocks all(samples_of(*enclosed), Threads(1));
    for (std::uint32_t b = 0; b < all.block_count(); ++b) sketches.push_back(all.sketch_of(b));
  }
  messages.from_root(sketches);
  return sketches;
}

/// From the root to those whose share it is.
void learn_own(const Messages& messages, const Shares& shares, const Tetrahedralization* enclosed,
               SampleBlocks& blocks) {
  std::vector<std::vector<Vec3>> shared(static_cast<std::size_t>(messages.size()));
  if (enclosed != nullptr)
    for (std::size_t r = 0; r < shared.size(); ++r) {
      const SampleRange range = shares.samples_of(r);
      const auto samples = samples_of(*enclosed).subspan(range.begin, range.size());
      shared[r].assign(samples.begin(), samples.end());
    }
  const std::vector<Vec3> own = std::move(messages.exchange(shared).front());
  const auto rank = static_cast<std::size_t>(messages.rank());
  const std::uint32_t begin = shares.samples_of(rank).begin;
  for (std::uint32_t b = shares.first_block(rank); b < shares.first_block(rank + 1); ++b) {
    const SampleRange range = blocks.samples_of(b);
    blocks.learn(b, std::span(own).subspan(range.begin - begin, range.size()));
  }
}

/// All tiles to the root.
std::vector<Tile> gather(const Messages& messages, Tile own) {
  const auto to_root = [&]<class T>(std::vector<T>& items) {
    std::vector<std::vector<T>> out(static_cast<std::size_t>(messages.size()));
    out.front() = std::move(items);
    return messages.exchange(out);
  };
  auto tetrahedra = to_root(own.tetrahedra);
  auto neighbours = to_root(own.neighbours);
  auto open = to_root(own.open);
  std::vector<Tile> tiles;
  if (messages.is_root())
    for (std::size_t r = 0; r < tetrahedra.size(); ++r)
      tiles.push_back({std::move(tetrahedra[r]), std::move(neighbours[r]), std::move(open[r])});
  return tiles;
}

} // namespace

std::vector<Tile> make_tiles(const Messages& messages, const Tetrahedralization* enclosed, const WatchGrowth& watch,
                             TileFigures& figures) {
  figures = {};
  const std::uint64_t sent_before = messages.bytes_sent();
  const Frame frame = messages.from_root(frame_of(enclosed));
  std::optional<SampleBlocks> blocks;
  std::optional<Shares> shares;
  or_end_all(messages, [&] {
    blocks.emplace(frame.samples, sketch(messages, enclosed));
    shares.emplace(frame.samples, blocks->block_count(), messages.size());
    learn_own(messages, *shares, enclosed, *blocks);
  });

  const SampleRange own = shares->samples_of(static_cast<std::size_t>(messages.rank()));
  TileProgress progress(watch, own.size());
  Supply supply(messages, *shares, *blocks, progress);
  Tile tile;
  together(
      messages,
      [&] {
        if (own.size() > 0)
          if (auto made = make_tile(frame.corners, *blocks, own, progress, &supply)) tile = std::move(*made);
        supply.serve();
      },
      [&] { supply.fail(); });
  // Later stages have them all.
  const std::uint64_t tetrahedra = messages.sum(tile.tetrahedra.size());
  together(
      messages, [&] { if (messages.is_root() && watch) watch(1, tetrahedra); }, [] {});
  if (progress.given_up()) return {};
  std::vector<Tile> tiles;
  or_end_all(messages, [&] { tiles = gather(messages, std::move(tile)); });
  figures.rounds = supply.rounds();
  figures.samples_fetched = messages.sum(supply.samples_fetched());
  figures.bytes_sent = messages.sum(messages.bytes_sent() - sent_before);
  figures.memory_of_others = messages.largest(messages.is_root() ? 0 : peak_memory_bytes());
  return tiles;
}

} // namespace eigencrust::mpi
