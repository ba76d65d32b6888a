#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace footing::study::bundle {

/// The numbers that stand for participants' codes in an exported data set, in random order. They
/// are kept in a file outside the data set, readable by its owner alone, so that another export
/// gives the same numbers. Without that file nobody knows who is who.
class ParticipantKey {
 public:
  /// A file's text: a header, then "NUMBER,CODE" a line. InvalidData that names file and line.
  static Result<ParticipantKey> Parse(std::string_view text, const std::string& file);

  /// Gives codes that have no number yet the next ones; `seed` decides which gets which.
  void Add(std::vector<std::string> codes, std::uint64_t seed);

  /// "sub-07". The code must have a number.
  std::string SubjectOf(const std::string& code) const;
  std::string Text() const;

 private:
  std::map<std::string, std::size_t> number_of_;
};

}  // namespace footing::study::bundle
