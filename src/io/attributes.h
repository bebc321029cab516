// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What readers and writers share about attributes.
#pragma once

#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

struct ViewerColours;

/// Gives out names that were not given out before: name, name_2, name_3 ...
class UniqueNames {
 public:
  UniqueNames(std::initializer_list<std::string> taken = {}) : taken_(taken) {}
  std::string operator()(const std::string& name);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::uint64_t> last_suffix_; ///< so that many equal names take no quadratic time
};

enum class NumberKind : std::uint8_t { natural, whole, real }; ///< unsigned, signed, floating

/// Of the attribute that holds numbers of so many bytes: whole ones of 64 bits become float64, real ones of 16 float32.
ScalarType attribute_type(NumberKind kind, std::size_t bytes);

/// append_scan without the scan numbers.
void append_rows(PointCloud& cloud, PointCloud next);

/// The rows of the cloud in that order, which increases, with all that belongs to them.
void keep_rows(PointCloud& cloud, std::span<const std::uint32_t> rows);

/// One warning that lists the attributes a format has no room for; what the program made itself is not worth one.
/// \param colours those that it holds, or null
/// \param with_alpha the format holds alpha too
/// \param kept others that it holds
void warn_lost_attributes(const std::vector<Attribute>& attributes, const std::string& of, const ViewerColours* colours,
                          bool with_alpha, const std::string& format, std::vector<std::string>& warnings,
                          const std::vector<const Attribute*>& kept = {});

/// \throws Error{usage} unless every attribute has `rows` rows and sound list offsets
void check_attributes(const std::vector<Attribute>& attributes, std::size_t rows, const std::string& of);

} // namespace eigencrust::io
