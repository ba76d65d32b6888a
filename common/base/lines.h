#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

/// Lines, words and fields of text files.
namespace footing::text {

/// The lines of a text, one after the other, without their ends (LF or CR LF).
class Lines {
 public:
  /// Without a byte order mark at its beginning, as spreadsheets and editors of Windows write it.
  Lines(std::string_view text, std::string file);

  /// The next line, or nothing at the end.
  std::optional<std::string_view> Next();
  /// The next line that is not blank.
  std::optional<std::string_view> NextFull();
  /// The next line that is not blank and no comment: the first character of a comment is #.
  std::optional<std::string_view> NextRow();

  std::size_t bytes_left() const { return rest_.size(); }
  const std::string& file() const { return file_; }
  /// Of the line that Next returned last, from 1; 0 before the first.
  std::size_t number() const { return number_; }
  /// "FILE, line N: MESSAGE", of the line that Next returned last.
  Error Fault(const std::string& message) const;

 private:
  std::string_view rest_;
  std::string file_;
  std::size_t number_ = 0;
};

/// Without the blanks around it.
std::string_view Trim(std::string_view text);

/// Words between blanks; fields between separators, trimmed, empty ones included.
std::vector<std::string_view> SplitAtBlanks(std::string_view line);
std::vector<std::string_view> Fields(std::string_view line, char separator);

/// Takes the next word off the front of `line`; empty at its end.
std::string_view TakeWord(std::string_view& line);

bool EqualsIgnoringCase(std::string_view a, std::string_view b);

/// `word` in quotes for a message: shortened, controls and what is not UTF-8 as ?.
std::string Quoted(std::string_view word);

}  // namespace footing::text
