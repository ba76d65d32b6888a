#include "common/runtime/lines_of_keys.h"

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>

namespace footing::config {
namespace {

/// Goes over a text and counts the lines that it has passed; copies count together.
class LineCounter {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  LineCounter(const char* at, int* line) : at_(at), line_(line) {}

  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  LineCounter operator++(int) {
    const LineCounter before = *this;
    ++*this;
    return before;
  }
  bool operator==(const LineCounter& other) const { return at_ == other.at_; }
  bool operator!=(const LineCounter& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

/// Notes the keys of the outermost object as the parser comes by.
class KeyNotes : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit KeyNotes(const int& line) : line_(line) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return Deeper(1); }
  bool end_object() override { return Deeper(-1); }
  bool start_array(std::size_t) override { return Deeper(1); }
  bool end_array() override { return Deeper(-1); }
  bool key(string_t& name) override {
    if (depth_ == 1) lines_[name] = line_;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
    return false;
  }

  const std::map<std::string, int>& lines() const { return lines_; }

 private:
  bool Deeper(int by) {
    depth_ += by;
    return true;
  }

  const int& line_;
  int depth_ = 0;
  std::map<std::string, int> lines_;
};

}  // namespace

std::map<std::string, int> LinesOfKeys(const std::string& text) {
  int line = 1;
  KeyNotes notes(line);
  nlohmann::json::sax_parse(LineCounter(text.data(), &line),
                            LineCounter(text.data() + text.size(), &line), &notes,
                            nlohmann::detail::input_format_t::json, true, true);
  return notes.lines();
}

}  // namespace footing::config
