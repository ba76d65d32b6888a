#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/runtime/timer.h"

namespace footing::study {

using timer::Waited;

/// The experimenter's terminal, and the event loop of the program: everything that waits, waits
/// here. Prompts go to standard error, answers come from standard input. While it exists SIGINT and
/// SIGTERM end waits, not the program.
class Console {
 public:
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  boost::asio::io_context& io();

  /// While an answer is awaited, the last line of its prompt follows again.
  void Print(const std::string& line);
  /// The next line that is typed; on a terminal, from the prompt on. Failure when the program is
  /// interrupted or the input has ended.
  Result<std::string> Ask(const std::string& prompt);

  /// Switches to single keys, without Enter, or back; a terminal does not show them. What was typed
  /// before does not count.
  void ReadKeys(bool on);
  /// The next whole line that was typed, while single keys do not count; nothing when there is
  /// none.
  std::optional<std::string> TakeLine();
  /// Drops unread input of a terminal.
  void DropTypedAhead();
  /// The oldest key that was pressed since; nothing when there is none.
  std::optional<char> TakeKey();

  /// Handles events until the condition holds, which is asked after each of them.
  Waited RunUntil(const std::function<bool()>& condition, double within_s);
  bool interrupted() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Error of an interrupted session, which can go on later.
Error Interrupted();

}  // namespace footing::study
