#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/result/result.h"

/// Reading and writing of the numbers and lines that motion files are made of, the same under every
/// locale.
namespace footing::motion {

/// The lines of a text, one after the other, without their ends (LF or CR LF).
class Lines {
 public:
  Lines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

  /// The next line, or nothing at the end.
  std::optional<std::string_view> Next();
  /// The next line that is not blank.
  std::optional<std::string_view> NextFull();

  std::size_t bytes_left() const { return rest_.size(); }
  const std::string& file() const { return file_; }
  /// "FILE, line N: MESSAGE", of the line that Next returned last.
  Error Fault(const std::string& message) const;

 private:
  std::string_view rest_;
  std::string file_;
  std::size_t number_ = 0;
};

std::string_view Trim(std::string_view text);

/// Words between blanks; fields between separators, trimmed, empty ones included.
std::vector<std::string_view> Words(std::string_view line);
std::vector<std::string_view> Fields(std::string_view line, char separator);

/// Takes the next word off the front of `line`; empty at its end.
std::string_view TakeWord(std::string_view& line);

bool EqualsIgnoringCase(std::string_view a, std::string_view b);

/// A finite number that is the whole of `word`, or nothing.
std::optional<double> ToNumber(std::string_view word);
/// A whole number, not negative, or nothing.
std::optional<std::size_t> ToCount(std::string_view word);

/// `word` in quotes for a message: shortened, unprintable characters as ?.
std::string Quoted(std::string_view word);

/// Appends the number with so many decimals; minus zero is zero.
void AppendFixed(std::string& text, double value, int decimals);

}  // namespace footing::motion
