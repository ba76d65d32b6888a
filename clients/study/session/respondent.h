#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace footing::study {

/// Answers of a participant who is not there: random, from a seed. Whatever they answer is marked
/// synthetic in the journal.
struct Respondent {
  std::uint64_t seed = 1;
  std::string participant;

  /// A whole number from `least` to `greatest`, each as likely.
  int Rate(const std::string& interface, const std::string& item, int least, int greatest) const;
  /// One of them, each as likely. `choices` must not be empty.
  std::string Choose(const std::string& interface, const std::string& question,
                     const std::vector<std::string>& choices) const;
  std::string Answer(const std::string& interface, const std::string& question) const;
};

}  // namespace footing::study
