// SPDX-License-Identifier: GPL-3.0-or-later
#include "messages.h"

#include <cstdio>
#include <new>
#include <nlohmann/json.hpp>

#include "printable.h"

namespace eigencrust::cli {
namespace {

// One stderr per process.
bool bar_is_shown = false;
bool json_is_spoken = false;

/// Allocates nothing.
void print_line(const char* begin, const char* text) {
  std::fputs(begin, stderr);
  print_clean(text, [](std::string_view piece) { std::fwrite(piece.data(), 1, piece.size(), stderr); });
  std::fputc('\n', stderr);
}

} // namespace

void speak_json() { json_is_spoken = true; }
bool speaks_json() { return json_is_spoken; }

void clear_progress() {
  if (!bar_is_shown) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  bar_is_shown = false;
}

void show_progress(const std::string& line) {
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
  bar_is_shown = true;
}

std::string json_text(std::string_view text) {
  return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_json(std::string_view members) {
  std::fprintf(stderr, "{%.*s}\n", static_cast<int>(members.size()), members.data());
  std::fflush(stderr);
}

void print_warning(const std::string& text) {
  if (json_is_spoken) return print_json("\"event\":\"warning\",\"text\":" + json_text(text));
  print_warning_of(text.c_str());
}

void print_warning_of(const char* text) {
  clear_progress();
  print_line("eigencrust: warning: ", text);
}

void print_error(const char* text) {
  if (json_is_spoken) {
    try {
      return print_json("\"event\":\"error\",\"text\":" + json_text(text));
    } catch (const std::bad_alloc&) {
      // As it is: what is said of memory needs no quoting.
      std::fprintf(stderr, "{\"event\":\"error\",\"text\":\"%s\"}\n", text);
      return;
    }
  }
  clear_progress();
  print_line("eigencrust: error: ", text);
}

void print_end(int status) {
  if (json_is_spoken) std::fprintf(stderr, "{\"event\":\"finished\",\"status\":%d}\n", status);
}

} // namespace eigencrust::cli
