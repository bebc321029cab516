// SPDX-License-Identifier: GPL-3.0-or-later
// The run that a report tells of, once more: the same words, on inputs that are the same to the bit.
#include <fstream>
#include <nlohmann/json.hpp>

#include "files.h"
#include "standard_streams.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

using Json = nlohmann::json;

Json read_report(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || is_folder(path))
    throw Error(ErrorKind::input, path, "the report cannot be read", "check the name of the file");
  Json report = Json::parse(file, nullptr, false);
  const bool sound = report.is_object() && report.contains("command") && report["command"].is_array() &&
                     report["command"].size() > 1 && report.contains("input") && report["input"].contains("files");
  if (!sound) throw Error(ErrorKind::input, path, "this is no report of a run", "give the file that --report wrote");
  return report;
}

void check_inputs(const Json& report, const std::string& path) {
  for (const Json& file : report["input"]["files"]) {
    const std::string input = file.value("path", ""), hash = file.value("sha256", "");
    std::error_code ignored;
    if (is_standard_output(input) || input.starts_with("/dev/") || input.starts_with("/proc/"))
      throw Error(ErrorKind::input, path, "the run read " + input + ", which is gone", "save what it read to a file");
    if (!std::filesystem::exists(input, ignored))
      throw Error(ErrorKind::input, input, "an input of the run is not here",
                  "call rerun in the folder where the run took place");
    if (sha256_of_file(input) != hash)
      throw Error(ErrorKind::input, input, "the file is not the one that the run read: its SHA-256 differs",
                  "bring it back, or run the command of the report by hand");
  }
}

/// Removes an option with its value, however it is written.
void drop(std::vector<std::string>& words, const std::string& name, const std::string& letter) {
  std::vector<std::string> kept;
  bool only_files = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    only_files = only_files || word == "--";
    if (!only_files && (word == name || (!letter.empty() && word == letter)))
      ++i;
    else if (only_files || !(word.starts_with(name + "=") ||
                             (!letter.empty() && word.starts_with(letter) && !word.starts_with("--"))))
      kept.push_back(word);
  }
  words = std::move(kept);
}

/// The words that made the report, but for the report itself: what is read is not written.
std::vector<std::string> words_of(const Json& report, const std::string& path) {
  std::vector<std::string> words;
  for (const Json& word : report["command"]) {
    if (!word.is_string())
      throw Error(ErrorKind::input, path, "the command in the report is damaged", "give the file that --report wrote");
    words.push_back(word.get<std::string>());
  }
  words.erase(words.begin()); // the program
  drop(words, "--report", "");
  return words;
}

} // namespace

int rerun_verb(const Arguments& arguments) {
  std::string path, output, report_path;
  OptionTable app("The run that a report tells of, once more. Its inputs have to be the same, bit by bit.",
                  "eigencrust rerun");
  app.add_option("REPORT", path, "JSON file that --report wrote")->required()->type_name(file_to_read);
  app.add_option("-o,--output", output, "Where the result goes [as in the run]")->type_name(file_to_write);
  app.add_option("--report", report_path, "Write a report of this run [none]")->type_name(file_to_write);
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const Json report = read_report(path);
  std::vector<std::string> words = words_of(report, path);
  if (!words.empty() && words.front() == "rerun")
    throw Error(ErrorKind::input, path, "this is the report of a rerun", "give that of the first run");
  check_inputs(report, path);
  std::vector<std::string> added;
  if (!output.empty()) {
    drop(words, "--output", "-o");
    added = {"-o", output};
  }
  if (!report_path.empty()) added.insert(added.end(), {"--report", report_path});
  words.insert(words.begin() + (find_verb(words.front()) != nullptr ? 1 : 0), added.begin(), added.end());
  std::vector<std::string> command{"eigencrust"};
  command.insert(command.end(), words.begin(), words.end());
  return run_command({words, command, {}, arguments.ranks});
}

} // namespace eigencrust::cli
