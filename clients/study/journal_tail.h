#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/study/report/event.h"

namespace footing::study::simulate {

/// What another program appends to a journal.
class JournalTail {
 public:
  explicit JournalTail(std::string path) : path_(std::move(path)) {}

  /// The whole lines since the last call; none while there is no file.
  std::vector<records::Event> ReadNew();

 private:
  std::string path_;
  std::size_t read_bytes_ = 0;
};

}  // namespace footing::study::simulate
