// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of eigencrust-quality that holds this program against others.
#pragma once

#include <string>

namespace eigencrust::bench {

struct ContestArguments {
  std::string contest; ///< words, separated by commas, of which a case's group/name contains one; empty: all
  std::string data, field, work;
  std::string program, peers, python;
  std::string table, page; ///< files to write; empty: the table goes to stdout
  std::string pictures;    ///< folder, beside the table, for the pictures it shows; empty: it shows none
  bool list = false;
  bool again = false; ///< run also what the work folder has the outcome of
  bool keep_meshes = false;
  unsigned threads = 0;

  // Of the steps that run in processes of their own: make, measure, draw, curves.
  std::string step, folder, mesh, other, picture;
};

/// \param itself the path of this program
void run_contests(const ContestArguments& arguments, const std::string& itself);

} // namespace eigencrust::bench
