#include "clients/study/journal_tail.h"

#include <sys/stat.h>

#include <fstream>
#include <string>

namespace footing::study::simulate {

std::vector<records::Event> JournalTail::ReadNew() {
  struct stat file {};
  if (::stat(path_.c_str(), &file) != 0) return {};
  if (static_cast<std::size_t>(file.st_size) <= read_bytes_) return {};
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(read_bytes_));
  std::vector<records::Event> events;
  std::string line;
  while (std::getline(in, line) && !in.eof()) {  // A line without its end is still being written.
    read_bytes_ += line.size() + 1;
    if (auto event = records::ParseLine(line)) events.push_back(std::move(event).value());
  }
  return events;
}

}  // namespace footing::study::simulate
