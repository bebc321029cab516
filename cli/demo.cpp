// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "bundled.h"
#include "command.h"
#include "files.h"

namespace eigencrust::cli {
namespace {

namespace fs = std::filesystem;

/// The bundled scan, named in the shorter of two ways, for people to read.
fs::path bundled_scan() {
  const std::optional<fs::path> scan = find_bundled(fs::path("examples") / "teapot_scan.ply");
  if (!scan)
    throw Error(ErrorKind::input, "demo", "the bundled scan teapot_scan.ply was not found",
                "run it from the source tree or install the program");
  std::error_code ignored;
  const fs::path from_here = fs::proximate(*scan, ignored);
  return ignored || from_here.native().size() >= scan->native().size() ? *scan : from_here;
}

} // namespace

int demo_verb(const Arguments& arguments) {
  std::string folder = "eigencrust-demo";
  OptionTable app("Reconstructs the bundled teapot scan: mesh, report and a picture of both.", "eigencrust demo");
  app.add_option("-o,--output", folder, "Folder for teapot.ply, teapot.json and teapot.png")
      ->type_name("DIR")
      ->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const std::string scan = bundled_scan().string();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!is_folder(folder))
    throw Error(ErrorKind::input, folder, "the folder cannot be created", "choose another one with -o");
  const std::string mesh = (fs::path(folder) / "teapot.ply").string(),
                    report = (fs::path(folder) / "teapot.json").string();
  const auto show = [](const std::vector<std::string>& words) {
    std::cout << "$ eigencrust";
    for (const std::string& word : words) std::cout << " " << printable(word);
    std::cout << std::endl;
    return words;
  };
  const auto call = [&](int (*verb)(const Arguments&), std::vector<std::string> words) {
    show(words);
    std::vector<std::string> command{"eigencrust"};
    command.insert(command.end(), words.begin(), words.end());
    const bool named = words.front() == "check" || words.front() == "render";
    return verb({{words.begin() + (named ? 1 : 0), words.end()}, command, {}, arguments.ranks});
  };
  const int status = call(reconstruct_verb, {scan, "-o", mesh, "--report", report});
  if (status != 0) return status;
  return call(render_verb, {"render", scan, mesh, "-o", (fs::path(folder) / "teapot.png").string(), "--width", "800",
                            "--height", "600", "--up", "z", "--azimuth", "-60", "--point-size", "1.5"});
}

} // namespace eigencrust::cli
