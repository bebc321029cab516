// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/observer.h>

#include <string>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>

namespace eigencrust {

Observer* default_observer() {
  static Observer silent; // has no state
  return &silent;
}

void throw_if_cancelled(Observer& observer, std::string_view stage) {
  if (observer.cancelled()) throw Error(ErrorKind::cancelled, std::string(stage), "cancelled", "start again to finish");
}

const char* version() { return EIGENCRUST_VERSION; }

} // namespace eigencrust
