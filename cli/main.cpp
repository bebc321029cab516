// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>
#include <stdexcept>
#include <system_error>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "command.h"
#include "removed_options.h"

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
  info INPUT...                  what is in a cloud: counts, bounds, spacing; forecast of memory and time
  check MESH                     closed? manifold? oriented? genus, volume, self-intersections
  compare MESH REFERENCE         distances both ways, F-score, volume IoU
  render MESH -o PNG             a picture without a display
  demo [-o DIR]                  the bundled scan, reconstructed, with its report and picture

Exit status: 0 done; 2 usage; 3 input unreadable or unusable; 4 memory refused or exhausted; 5 no surface;
6 a guarantee was not met; 130 cancelled.
)";

constexpr const char* exhausted =
    "memory is exhausted (memory); give fewer points or take a machine with more, info forecasts what is needed";

/// Allocates nothing, for there may be nothing left.
int fail(const char* message, ErrorKind kind) {
  cli::clear_progress();
  if (cli::status_of_files() >= 0) { // only the words about them failed
    std::fputs("eigencrust: warning: the summary could not be printed; the output files are complete\n", stderr);
    return cli::status_of_files();
  }
  std::fputs("eigencrust: error: ", stderr);
  cli::print_clean(message, [](std::string_view piece) { std::fwrite(piece.data(), 1, piece.size(), stderr); });
  std::fputc('\n', stderr);
  return static_cast<int>(kind);
}

/// As above, for what other libraries throw.
int fail(const std::exception& error, const char* rest, ErrorKind kind) {
  std::array<char, 1000> text{};
  std::snprintf(text.data(), text.size(), "%.800s %s", error.what(), rest);
  return fail(text.data(), kind);
}

using Verbs = std::map<std::string, int (*)(const cli::Arguments&)>;

/// Letters to insert, to remove, to change or to swap with the next (restricted Damerau-Levenshtein distance).
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// The first word is an input where it is no verb; but a word without a dot or a slash that names no file was meant
/// as a verb. \throws Error{usage}
void require_input(const std::string& word, const Verbs& verbs) {
  std::error_code ignored;
  if (word.empty() || word.front() == '-' || word.find_first_of("./") != std::string::npos ||
      std::filesystem::exists(word, ignored))
    return;
  std::string nearest, all;
  std::size_t least = 3; // more letters wrong are no slip
  for (const auto& [verb, call] : verbs) {
    all.append(all.empty() ? "" : ", ").append(verb);
    const std::size_t distance = edits(word, verb);
    const bool begins = word.size() >= 3 && verb.starts_with(word);
    if (distance < least || (begins && nearest.empty())) {
      least = std::min(least, distance);
      nearest = verb;
    }
  }
  throw Error(ErrorKind::usage, "command line", "unknown verb or no such file: " + word,
              nearest.empty() ? "the verbs are " + all : "did you mean " + nearest + "?");
}

int run(const cli::Arguments& all) {
  static const Verbs verbs{{"reconstruct", cli::reconstruct_verb},
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
  reject_removed_options(all);
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
  if (verb == verbs.end()) {
    require_input(first, verbs);
    return cli::reconstruct_verb(all);
  }
  return verb->second({{all.words.begin() + 1, all.words.end()}, all.command});
}

/// Freed arrays stay with the process. Stage after stage takes arrays of the same size, and fresh pages are slow
/// (docs/decisions/0022).
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

/// The first files that are opened get the numbers of standard streams that are closed: what is meant for a terminal
/// would be written into a mesh. Nothing can be written to what takes their place.
void keep_stream_numbers() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      const int unwritable = open("/dev/null", O_RDONLY);
      if (unwritable >= 0 && unwritable != stream) close(unwritable);
    }
}

int run_safely(const cli::Arguments& arguments) {
  try {
    const int status = run(arguments);
    std::cout.flush();
    if (!std::cout)
      return fail("standard output could not be written (output); free some space or mend the pipe", ErrorKind::input);
    return status;
  } catch (const Error& error) {
    return fail(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    return fail(exhausted, ErrorKind::memory);
  } catch (const std::length_error&) { // a container larger than any memory
    return fail(exhausted, ErrorKind::memory);
  } catch (const std::system_error& error) { // of files, threads, locks
    return fail(error, "(system); check the names, the permissions and the limits", ErrorKind::input);
  } catch (const std::exception& error) {
    return fail(error, "(internal); report this as a fault of the program", ErrorKind::guarantee);
  }
}

} // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  keep_stream_numbers();
  cli::catch_interrupts();
  cli::CleanBuffer clean(std::cout.rdbuf());
  std::streambuf* const bare = std::cout.rdbuf(&clean);
  int status = static_cast<int>(ErrorKind::memory);
  try {
    cli::Arguments arguments;
    arguments.command.assign(argv, argv + argc);
    arguments.words.assign(argv + (argc > 0 ? 1 : 0), argv + argc);
    status = run_safely(arguments);
  } catch (const std::bad_alloc&) {
    status = fail(exhausted, ErrorKind::memory);
  }
  std::cout.rdbuf(bare);
  return status;
}
