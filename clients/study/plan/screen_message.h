#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

/// Messages between footing-study and the participant's survey screen: one JSON object a frame.
namespace footing::study::screen {

/// Message to the screen.
struct Shown {
  std::uint64_t number = 0;               ///< Number, from 1; 0: no question, `item` is a message.
  std::string title = {};                 ///< Subject of the question.
  std::string item = {};                  ///< Item rated, or the question.
  std::string scale = {};                 ///< Meaning of the ends of a rating.
  int least = 0, greatest = 0;            ///< Range of a rating; both 0: free text, one line.
  int position = 0, count = 0;            ///< Place among the survey's items, from 1.
  std::vector<std::string> choices = {};  ///< One of them is the answer; empty: any is.

  bool is_rating() const { return least < greatest; }
  bool operator==(const Shown&) const = default;
};

/// Message from the screen: one answer to the question of that number.
struct Reply {
  std::uint64_t number = 0;
  std::string text;

  bool operator==(const Reply&) const = default;
};

/// Answers of more bytes are cut; longer frames end the connection.
inline constexpr std::size_t kMostAnswerBytes = 4000;
inline constexpr std::uint32_t kMostFrameBytes = 16 * 1024;

/// JSON text of a message.
std::string ToText(const Shown& shown);
std::string ToText(const Reply& reply);
/// Parses a message; InvalidData when the text is not such an object.
Result<Shown> ParseShown(std::string_view text);
Result<Reply> ParseReply(std::string_view text);

/// A whole number within the range that is the whole of `text`, or nothing.
std::optional<int> ParseRating(const std::string& text, int least, int greatest);

/// The choice that is the whole of `text`, by its name in any case or by its number from 1.
std::optional<std::string> ParseChoice(const std::string& text,
                                       const std::vector<std::string>& choices);
/// "1 wrist   2 arm", as they are shown.
std::string ChoiceLine(const std::vector<std::string>& choices);

/// Whether the text answers the question: a rating within its range, a choice, or any text.
bool Answers(const Shown& shown, const std::string& text);

}  // namespace footing::study::screen
