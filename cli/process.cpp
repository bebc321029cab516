// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "process.h"

#include "disk_memory.h"
#include "messages.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

/// Allocates nothing, for there may be nothing left.
int fail(const char* message, ErrorKind kind) {
  if (status_of_files() >= 0) { // only the words about them failed
    print_warning_of("the summary could not be printed; the output files are complete");
    return status_of_files();
  }
  print_error(message);
  return static_cast<int>(kind);
}

/// As above, for what other libraries throw.
int fail(const std::exception& error, const char* rest, ErrorKind kind) {
  std::array<char, 1000> text{};
  std::snprintf(text.data(), text.size(), "%.800s %s", error.what(), rest);
  return fail(text.data(), kind);
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

int run(const Arguments& arguments) {
  try {
    if (asks_for_json(arguments.words)) speak_json();
    const int status = run_command(arguments);
    std::cout.flush();
    if (!std::cout)
      return fail("standard output could not be written (output); free some space or mend the pipe", ErrorKind::input);
    return status;
  } catch (const Error& error) {
    return fail(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    return fail(memory_is_exhausted(), ErrorKind::memory);
  } catch (const std::length_error&) { // a container larger than any memory
    return fail(memory_is_exhausted(), ErrorKind::memory);
  } catch (const std::system_error& error) { // of files, threads, locks
    return fail(error, "(system); check the names, the permissions and the limits", ErrorKind::input);
  } catch (const std::exception& error) {
    return fail(error, "(internal); report this as a fault of the program", ErrorKind::guarantee);
  }
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

} // namespace

int run_process(int argc, char** argv, Ranks* ranks) {
  keep_stream_numbers();
  catch_interrupts();
  CleanBuffer clean(std::cout.rdbuf());
  std::streambuf* const bare = std::cout.rdbuf(&clean);
  int status = static_cast<int>(ErrorKind::memory);
  try {
    Arguments arguments;
    arguments.command.assign(argv, argv + argc);
    arguments.ranks = ranks;
    arguments.words.assign(argv + (argc > 0 ? 1 : 0), argv + argc);
    status = run(arguments);
  } catch (const std::bad_alloc&) {
    status = fail(memory_is_exhausted(), ErrorKind::memory);
  }
  std::cout.rdbuf(bare);
  print_end(status);
  return status;
}

} // namespace eigencrust::cli
