#pragma once

#include <cstdint>
#include <string>

namespace footing::study {

/// Answers of a participant who is not there: random, from a seed. Whatever they answer is marked
/// synthetic in the journal.
struct Respondent {
  std::uint64_t seed = 1;
  std::string participant;

  /// A whole number from `least` to `greatest`, each as likely.
  int Rate(const std::string& interface, const std::string& item, int least, int greatest) const;
  std::string Answer(const std::string& interface, const std::string& question) const;
};

}  // namespace footing::study
