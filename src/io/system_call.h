// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// System calls that a signal, or a descriptor that does not block, sends back before they are done.
#pragma once

#include <poll.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <eigencrust/error.h>

namespace eigencrust::io {

/// \param code errno, or 0: the system did not say why. \throws Error{input}
[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& cause, int code,
                              const std::string& remedy) {
  throw Error(ErrorKind::input, path.string(), code == 0 ? cause : cause + ": " + std::generic_category().message(code),
              remedy);
}

/// Calls again while a signal interrupts. `call` returns a negative number and sets errno where it fails.
template <class Call>
auto uninterrupted(Call&& call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

/// As above, and waits where the descriptor is not ready. \param events POLLIN or POLLOUT
template <class Call>
auto when_ready(int descriptor, short events, Call&& call) {
  for (;;) {
    const auto result = uninterrupted(call);
    if (result >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) return result;
    pollfd waiting{descriptor, events, 0};
    if (uninterrupted([&] { return poll(&waiting, 1, -1); }) < 0) return result;
  }
}

} // namespace eigencrust::io
