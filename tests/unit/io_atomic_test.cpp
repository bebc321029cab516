// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <locale>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0);
  return status.st_mode & 07777;
}

TEST(IoAtomic, WritesAndReplaces) {
  const TempDir folder;
  const std::string large(300000, 'x'); // more than any buffer
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "one"; });
  EXPECT_EQ(read_bytes(folder / "a.txt"), "one");
  write_file_atomically(folder / "a.txt", [&](std::ostream& out) { out << 1.5 << ' ' << large << 'y'; });
  EXPECT_EQ(read_bytes(folder / "a.txt"), "1.5 " + large + "y");
  write_file_atomically(folder / "empty", [](std::ostream&) {});
  EXPECT_EQ(read_bytes(folder / "empty"), "");
  EXPECT_EQ(files_in(folder.path()), 2u);
  write_file_atomically(folder / std::string(250, 'n'), [](std::ostream& out) { out << "long name"; });
  EXPECT_EQ(files_in(folder.path()), 3u);
}

TEST(IoAtomic, ARelativeNameMeansTheWorkingFolder) {
  const TempDir folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  write_file_atomically("a.txt", [](std::ostream& out) { out << "here"; });
  fs::current_path(before);
  EXPECT_EQ(read_bytes(folder / "a.txt"), "here");
}

TEST(IoAtomic, AFailingWriterLeavesTheOldFile) {
  const TempDir folder;
  write_bytes(folder / "a.txt", "old");
  const auto broken = [](std::ostream& out) {
    out << "half";
    out.flush();
    throw std::runtime_error("broken");
  };
  EXPECT_THROW(write_file_atomically(folder / "a.txt", broken), std::runtime_error);
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(IoAtomic, AFullDiskIsAnError) {
  const TempDir folder;
  write_bytes(folder / "a.txt", "old");
  // A limit on the size of files stands for the full disk.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 100000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = error_of(
      [&] { write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << std::string(200000, 'x'); }); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("cannot write"));
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);

  if (fs::exists("/dev/full")) {
    EXPECT_THAT(error_of([] { write_file_atomically("/dev/full", [](std::ostream& out) { out << "x"; }); }),
                HasSubstr("No space"));
  }
}

TEST(IoAtomic, FoldersAndMissingFolders) {
  const TempDir folder;
  const auto write = [](std::ostream& out) { out << "x"; };
  EXPECT_THAT(error_of([&] { write_file_atomically(folder.path(), write); }), HasSubstr("this is a folder"));
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "no/a.txt", write); }), HasSubstr("No such file"));
  EXPECT_THAT(error_of([&] { write_file_atomically("", write); }), HasSubstr("missing"));
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "no/", write); }), HasSubstr("missing"));
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(IoAtomic, PermissionsFollowTheUmaskOrTheOldFile) {
  const TempDir folder;
  const auto write = [](std::ostream& out) { out << "x"; };
  const mode_t before = umask(027);
  write_file_atomically(folder / "new", write);
  write_bytes(folder / "old", "");
  fs::permissions(folder / "old", fs::perms(0606));
  write_file_atomically(folder / "old", write);
  umask(before);
  EXPECT_EQ(mode_of(folder / "new"), 0640u);
  EXPECT_EQ(mode_of(folder / "old"), 0606u);
  fs::permissions(folder / "old", fs::perms(0444));
  if (geteuid() != 0) { // root may always write
    EXPECT_THROW(write_file_atomically(folder / "old", write), Error);
  }
}

TEST(IoAtomic, ALinkStaysAndItsTargetIsReplaced) {
  const TempDir folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/target", folder / "link");
  fs::create_symlink("link", folder / "link2");
  for (const char* text : {"new", "newer"}) { // first the target does not exist
    write_file_atomically(folder / "link2", [&](std::ostream& out) { out << text; });
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_TRUE(fs::is_symlink(folder / "link2"));
    EXPECT_EQ(read_bytes(folder / "sub/target"), text);
  }
  EXPECT_EQ(files_in(folder / "sub"), 1u);
}

TEST(IoAtomic, DevicesAreWrittenNotReplaced) {
  write_file_atomically("/dev/null", [](std::ostream& out) { out << "gone"; });
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(IoSha256, KnownDigests) {
  const TempDir folder;
  write_bytes(folder / "empty", "");
  write_bytes(folder / "abc", "abc");
  // FIPS 180-2, appendix B.1, and the well-known digest of nothing.
  EXPECT_EQ(sha256_of_file(folder / "abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder / "empty"), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_THROW(sha256_of_file(folder / "none"), Error);
}

} // namespace
} // namespace eigencrust
