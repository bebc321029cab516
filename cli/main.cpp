// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>
#include <new>

#include "command.h"

namespace {

using namespace eigencrust;

constexpr const char* overview =
    R"(Eigencrust: raw point clouds into watertight, manifold triangle meshes.

  eigencrust scan.ply -o mesh.ply               one cloud
  eigencrust a.ply b.ply c.ply -o mesh.ply      several scans of one scene
  eigencrust scan.ply -o mesh.ply --report r.json

Verbs (eigencrust VERB --help for the options of each):
  reconstruct INPUT... -o MESH   point clouds to a closed mesh; what happens without a verb
  orient INPUT... -o CLOUD       the cloud with normals that look outward
  classify INPUT... -o CLOUD     the cloud with a flag for inliers, and how sure that is
  info INPUT...                  what is in a cloud: counts, bounds, spacing, duplicates
  check MESH                     closed? manifold? oriented? genus, volume, self-intersections
  compare MESH REFERENCE         distances both ways, F-score, volume IoU
  render MESH -o PNG             a picture without a display
  demo [-o DIR]                  the bundled scan, reconstructed, with its report and picture

Exit status: 0 done; 2 usage; 3 input unreadable or unusable; 4 out of memory; 5 no surface;
6 a guarantee was not met; 130 cancelled.
)";

int fail(const std::string& message, ErrorKind kind) {
  cli::clear_progress();
  std::fprintf(stderr, "eigencrust: error: %s\n", message.c_str());
  return static_cast<int>(kind);
}

int run(const cli::Arguments& all) {
  static const std::map<std::string, int (*)(const cli::Arguments&)> verbs{{"reconstruct", cli::reconstruct_verb},
                                                                           {"orient", cli::orient_verb},
                                                                           {"classify", cli::classify_verb},
                                                                           {"info", cli::info_verb},
                                                                           {"check", cli::check_verb},
                                                                           {"compare", cli::compare_verb},
                                                                           {"render", cli::render_verb},
                                                                           {"demo", cli::demo_verb}};
  if (all.words.empty()) {
    std::cerr << overview;
    return static_cast<int>(ErrorKind::usage);
  }
  const std::string& first = all.words.front();
  if (first == "--help" || first == "-h" || first == "help") {
    std::cout << overview << "\nOptions of reconstruct:\n\n";
    return cli::reconstruct_verb({{"--help"}, all.command});
  }
  if (first == "--version") {
    std::cout << "eigencrust " << version() << "\n";
    return 0;
  }
  const auto verb = verbs.find(first);
  if (verb == verbs.end()) return cli::reconstruct_verb(all);
  return verb->second({{all.words.begin() + 1, all.words.end()}, all.command});
}

} // namespace

int main(int argc, char** argv) {
  cli::Arguments arguments;
  arguments.command.assign(argv, argv + argc);
  arguments.words.assign(argv + (argc > 0 ? 1 : 0), argv + argc);
  try {
    const int status = run(arguments);
    std::cout.flush();
    if (!std::cout)
      return fail("standard output could not be written (output); free some space or mend the pipe", ErrorKind::input);
    return status;
  } catch (const Error& error) {
    return fail(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    return fail("memory is exhausted (memory); use fewer points or a machine with more", ErrorKind::memory);
  } catch (const std::exception& error) {
    return fail(std::string(error.what()) + " (internal); report this as a fault of the program", ErrorKind::guarantee);
  }
}
