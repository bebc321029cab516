// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.h"

#include <sys/stat.h>

#include <cctype>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

namespace eigencrust::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, path, cause, remedy);
}

/// What a path leads to, whether or not it is there: the file itself, and its name in its folder.
struct Place {
  std::string path; ///< as it was given
  bool exists = false, is_device = false;
  struct stat file {};
  bool has_folder = false;
  struct stat folder {};
  std::string name;

  explicit Place(const fs::path& given) : path(given.string()) {
    exists = stat(given.c_str(), &file) == 0;
    is_device = exists && (S_ISCHR(file.st_mode) || S_ISBLK(file.st_mode));
    const fs::path end = follow_links(given), parent = end.parent_path();
    has_folder = stat(parent.empty() ? "." : parent.c_str(), &folder) == 0;
    name = end.filename().string();
  }
};

bool same(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

bool same(const Place& a, const Place& b) {
  if (a.is_device || b.is_device) return false; // they hold nothing that could be lost
  if (a.exists && b.exists) return same(a.file, b.file);
  return a.has_folder && b.has_folder && same(a.folder, b.folder) && a.name == b.name;
}

/// Is there a file behind this word? Not behind those of standard streams, which are named "-" here, too.
bool names_a_file(const std::string& word) { return !word.empty() && word != "-"; }

/// Can a file of this name come from a run that writes its stages into the folder?
bool is_stage_name(const std::string& name) {
  return name.size() > 3 && std::isdigit(static_cast<unsigned char>(name[0])) != 0 &&
         std::isdigit(static_cast<unsigned char>(name[1])) != 0 && name[2] == '_';
}

void refuse_impossible(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return;
  if (errno == ELOOP || errno == ENAMETOOLONG)
    fail(path, "no file can be written there: " + std::generic_category().message(errno), "choose another name");
}

} // namespace

void check_files(const NamedFiles& named) {
  std::vector<Place> read, written;
  for (const std::string& word : named.read) {
    if (!names_a_file(word)) continue;
    read.emplace_back(word);
    for (const fs::path& companion : companion_files(word)) read.emplace_back(companion);
  }
  for (const std::string& word : named.written) {
    if (!names_a_file(word)) continue;
    refuse_impossible(word);
    written.emplace_back(word);
    written.emplace_back(offset_file(word));
  }
  for (const Place& output : written)
    for (const Place& input : read)
      if (same(input, output)) fail(output.path, "the output would overwrite an input", "choose another name");
  for (std::size_t i = 0; i < written.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (same(written[i], written[j]))
        fail(written[i].path, "two outputs would be the same file", "choose another name");
  for (const std::string& word : named.folders) {
    if (!names_a_file(word)) continue;
    refuse_impossible(word);
    std::vector<Place> stages;
    std::error_code none;
    for (fs::directory_iterator entry(word, none), end; !none && entry != end; entry.increment(none))
      if (is_stage_name(entry->path().filename().string())) stages.emplace_back(entry->path());
    for (const Place& stage : stages)
      for (const Place& input : read)
        if (same(input, stage)) fail(stage.path, "a stage's output could overwrite an input", "choose another folder");
    const Place folder{fs::path(word) / "."};
    for (const Place& output : written)
      if (folder.exists && output.has_folder && same(output.folder, folder.file) && is_stage_name(output.name))
        fail(output.path, "a stage's output could be the same file", "choose another name");
  }
}

} // namespace eigencrust::cli
