// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear together, and the temporaries that they are until then.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include <eigencrust/io.h>

#include "io/temporary_file.h"
#include "support.h"

namespace eigencrust {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

const auto one = [](std::ostream& out) { out << "one"; };

TEST(OutputFiles, AppearTogether) {
  const TempDir folder;
  OutputFiles files;
  files.add(folder / "a", one);
  files.add(folder / "b", [](std::ostream& out) { out << "two"; });
  EXPECT_FALSE(fs::exists(folder / "a"));
  EXPECT_FALSE(fs::exists(folder / "b"));
  files.put_in_place();
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a", "b"));
  EXPECT_EQ(read_bytes(folder / "b"), "two");
}

TEST(OutputFiles, NoneAppearsWhereOneFails) {
  const TempDir folder;
  write_bytes(folder / "a", "old");
  {
    OutputFiles files;
    files.add(folder / "a", one);
    EXPECT_THROW(files.add(folder / "b", [](std::ostream&) { throw std::bad_alloc(); }), std::bad_alloc);
  }
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a"));
  EXPECT_EQ(read_bytes(folder / "a"), "old");
}

TEST(OutputFiles, TheFileOfOffsetsAppearsWithTheMesh) {
  const TempDir folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  WriteOptions shifted;
  shifted.shift = {-512000, -5412000, 0.5};
  const auto write = [&](const WriteOptions& options, bool finishes) {
    OutputFiles files;
    files.add_mesh(folder / "a.stl", mesh, options);
    if (finishes) files.put_in_place();
  };
  write(shifted, false);
  EXPECT_THAT(names_in(folder.path()), testing::IsEmpty());
  write(shifted, true);
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a.stl", "a.stl.offset.txt"));
  EXPECT_THAT(read_bytes(folder / "a.stl.offset.txt"), testing::EndsWith("\n512000 5412000 -0.5\n"));
  write({}, false); // what did not take its place leaves the older pair as it is
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a.stl", "a.stl.offset.txt"));
  write({}, true);
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a.stl"));
  write_bytes(folder / "a.stl.offset.txt", "of somebody else");
  write({}, true);
  EXPECT_EQ(read_bytes(folder / "a.stl.offset.txt"), "of somebody else");
  // Nothing can be beside a device.
  WriteOptions to_device = shifted;
  to_device.format = "stl";
  EXPECT_THAT(write_mesh("/dev/null", mesh, to_device).warnings,
              testing::ElementsAre(testing::HasSubstr("add 512000 5412000 -0.5 to its coordinates")));
}

TEST(OutputFiles, AHandlerRemovesWhatIsNotInPlace) {
  const TempDir folder;
  OutputFiles files;
  files.add(folder / "a", one);
  files.add(folder / "b", one);
  EXPECT_EQ(names_in(folder.path()).size(), 2u);
  remove_temporaries();
  EXPECT_TRUE(names_in(folder.path()).empty());
  EXPECT_THROW(files.put_in_place(), Error);
}

TEST(OutputFiles, WhatIsInPlaceStays) {
  const TempDir folder;
  OutputFiles files;
  files.add(folder / "a", one);
  files.put_in_place();
  remove_temporaries();
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a"));
}

TEST(Temporaries, StaleOnesGoAndLockedOnesStay) {
  const TempDir folder;
  const std::string suffix = io::temporary_suffix;
  write_bytes(folder / (".stale" + suffix), "half");
  write_bytes(folder / (".busy" + suffix), "half");
  write_bytes(folder / ("visible" + suffix), "of somebody else");
  fs::create_directory(folder / (".folder" + suffix));
  fs::create_symlink("visible" + suffix, folder / (".link" + suffix));
  const int busy = open((folder / (".busy" + suffix)).c_str(), O_RDWR);
  ASSERT_EQ(flock(busy, LOCK_EX), 0);
  write_file_atomically(folder / "a", one);
  EXPECT_THAT(names_in(folder.path()), testing::UnorderedElementsAre("a", ".busy" + suffix, "visible" + suffix,
                                                                     ".folder" + suffix, ".link" + suffix));
  close(busy);
  write_file_atomically(folder / "a", one);
  EXPECT_FALSE(fs::exists(folder / (".busy" + suffix)));
}

TEST(Temporaries, OneThatIsBeingWrittenStaysBesideOtherWriters) {
  const TempDir folder;
  OutputFiles slow;
  slow.add(folder / "slow", one);
  std::vector<std::thread> team;
  for (int k = 0; k < 4; ++k)
    team.emplace_back([&, k] {
      for (int i = 0; i < 50; ++i) write_file_atomically(folder / std::to_string(k), one);
    });
  for (std::thread& thread : team) thread.join();
  slow.put_in_place();
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("0", "1", "2", "3", "slow"));
}

TEST(Temporaries, NobodyLooksIntoThemWhoMayNotLookIntoTheFile) {
  const TempDir folder;
  write_bytes(folder / "secret", "old");
  fs::permissions(folder / "secret", fs::perms(0600));
  OutputFiles files;
  files.add(folder / "secret", [&](std::ostream&) {
    for (const std::string& name : names_in(folder.path())) {
      struct stat status {};
      ASSERT_EQ(stat((folder / name).c_str(), &status), 0);
      EXPECT_EQ(status.st_mode & 0777u, 0600u) << name;
    }
  });
  files.put_in_place();
}

TEST(Temporaries, SetUserBitsAreNotCopied) {
  const TempDir folder;
  write_bytes(folder / "a", "old");
  ASSERT_EQ(chmod((folder / "a").c_str(), 07755), 0);
  write_file_atomically(folder / "a", one);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777u, 0755u);
}

TEST(Temporaries, OwnersStayWhereTheSystemAllowsIt) {
  if (geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  const TempDir folder;
  write_bytes(folder / "a", "old");
  ASSERT_EQ(chown((folder / "a").c_str(), 12345, 23456), 0);
  write_file_atomically(folder / "a", one);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 12345u);
  EXPECT_EQ(status.st_gid, 23456u);
}

TEST(Output, APipeThatDoesNotBlockIsWaitedFor) {
  const TempDir folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string text(300000, 'x'); // more than a pipe holds
  std::string got;
  const int reading = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  std::thread reader([&] {
    std::array<char, 1000> part{};
    while (got.size() < text.size()) {
      const ssize_t size = read(reading, part.data(), part.size());
      if (size > 0) got.append(part.data(), static_cast<std::size_t>(size));
    }
  });
  const int writing = open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
  write_file_atomically("/proc/self/fd/" + std::to_string(writing), [&](std::ostream& out) { out << text; });
  reader.join();
  close(writing);
  close(reading);
  EXPECT_EQ(got, text);
}

TEST(Output, ALoopOfLinksIsAnError) {
  const TempDir folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_THROW(write_file_atomically(folder / "a", one), Error);
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a", "b"));
}

TEST(CompanionFiles, AreThoseThatAreRead) {
  const TempDir folder;
  write_bytes(folder / "a.ply", "");
  EXPECT_TRUE(companion_files(folder / "a.ply").empty());
  write_bytes(folder / "a.ply.vis", "");
  EXPECT_THAT(companion_files(folder / "a.ply"), testing::ElementsAre(folder / "a.ply.vis"));
  write_bytes(folder / "images.txt", "");
  EXPECT_EQ(companion_files(folder / "a.ply").size(), 2u);
}

TEST(ReadPointCloud, TellsTheDigestOfWhatItRead) {
  const TempDir folder;
  write_bytes(folder / "a.xyz", "0 0 0\n1 2 3\n");
  std::string sha256;
  read_point_cloud(folder / "a.xyz", {}, nullptr, &sha256);
  EXPECT_EQ(sha256, sha256_of_file(folder / "a.xyz"));
}

} // namespace
} // namespace eigencrust
