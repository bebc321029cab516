// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <new>
#include <stdexcept>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "messages.h"
#include "verbs.h"

namespace {

using namespace eigencrust;

constexpr const char* exhausted =
    "memory is exhausted (memory); give fewer points or take a machine with more, info forecasts what is needed";

int fail(const char* message, ErrorKind kind) {
  cli::print_error(message);
  return static_cast<int>(kind);
}

/// Before anything is parsed: what is wrong with the command line is told in the same way.
bool asks_for_json(const std::vector<std::string>& words) {
  bool json = false;
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (words[i] == "-q" || words[i] == "--quiet") return false;
    json = json || words[i] == "--progress=jsonl" || (i > 0 && words[i] == "jsonl" && words[i - 1] == "--progress");
  }
  return json;
}

int run(const cli::Arguments& arguments) {
  try {
    if (asks_for_json(arguments.words)) cli::speak_json();
    const int status = cli::run_command(arguments);
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
  } catch (const std::exception& error) {
    const std::string text = std::string(error.what()) + " (internal); report this as a fault of the program";
    return fail(text.c_str(), ErrorKind::guarantee);
  }
}

} // namespace

/// Freed arrays stay with the process. Stage after stage takes arrays of the same size, and fresh pages are slow
/// (docs/decisions/0022).
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

int main(int argc, char** argv) {
  keep_freed_memory();
  cli::Arguments arguments;
  arguments.command.assign(argv, argv + argc);
  arguments.words.assign(argv + (argc > 0 ? 1 : 0), argv + argc);
  const int status = run(arguments);
  cli::print_end(status);
  return status;
}
