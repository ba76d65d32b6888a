#include "clients/study/session/console.h"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <iostream>

#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::study {
namespace {

namespace asio = boost::asio;

constexpr double kAskS = 24 * 3600;  // A wait for a person has no end worth naming.

}  // namespace

class Console::Implementation {
 public:
  Implementation() : input_(io_) { terminal_ = ::tcgetattr(STDIN_FILENO, &before_) == 0; }

  ~Implementation() { ReadKeys(false); }

  /// Read only once something is asked: a program in the background must not touch its terminal. A
  /// regular file cannot be waited for, so it is read at once.
  void Open() {
    if (opened_) return;
    opened_ = true;
    boost::system::error_code error;
    const int descriptor = ::dup(STDIN_FILENO);
    if (descriptor < 0) {
      ended_ = true;
      return;
    }
    input_.assign(descriptor, error);
    if (error) {
      ReadWholeFile(descriptor);
      ::close(descriptor);
      return;
    }
    ReadOn();
  }

  void ReadWholeFile(int descriptor) {
    ended_ = true;
    for (;;) {
      const ssize_t bytes = ::read(descriptor, buffer_.data(), buffer_.size());
      if (bytes <= 0) return;
      typed_.append(buffer_.data(), static_cast<std::size_t>(bytes));
    }
  }

  void ReadOn() {
    input_.async_read_some(asio::buffer(buffer_),
                           [this](const boost::system::error_code& error, std::size_t bytes) {
                             typed_.append(buffer_.data(), bytes);
                             if (error) {
                               ended_ = true;
                               return;
                             }
                             ReadOn();
                           });
  }

  /// Input typed before a question does not answer it. Input from a pipe or file was written for
  /// it.
  void DropTypedAhead() {
    if (!terminal_) return;
    ::tcflush(STDIN_FILENO, TCIFLUSH);
    typed_.clear();
  }

  void ReadKeys(bool on) {
    if (!terminal_ || on == keys_) return;
    DropTypedAhead();
    keys_ = on;
    termios now = before_;
    if (on) now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }

  bool HasLine() const { return typed_.find('\n') != std::string::npos; }

  std::string TakeLine() {
    const std::size_t end = typed_.find('\n');
    std::string line = typed_.substr(0, end);
    typed_.erase(0, end == std::string::npos ? end : end + 1);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  Waited RunUntil(const std::function<bool()>& condition, double within_s) {
    return timer::RunUntil(io_, condition, within_s, [this] { return end_.asked(); });
  }

  asio::io_context io_{1};
  service_manager::ProgramEnd end_{io_};
  asio::posix::stream_descriptor input_;
  std::array<char, 256> buffer_{};
  std::string typed_;
  std::string prompt_;  ///< Last line of what is asked now; empty: nothing is.
  termios before_{};
  bool terminal_ = false;
  bool keys_ = false;
  bool opened_ = false;
  bool ended_ = false;
};

Console::Console() : implementation_(std::make_unique<Implementation>()) {}
Console::~Console() { timer::DropWaits(); }

boost::asio::io_context& Console::io() { return implementation_->io_; }

void Console::Print(const std::string& line) {
  const std::string& prompt = implementation_->prompt_;
  if (prompt.empty()) {
    std::cerr << line << std::endl;
    return;
  }
  // The cursor is behind the prompt, which would otherwise be gone from the sight of the person.
  std::cerr << "\n" << line << "\n" << prompt << " " << std::flush;
}

Result<std::string> Console::Ask(const std::string& prompt) {
  Implementation& own = *implementation_;
  own.ReadKeys(false);
  own.Open();
  own.DropTypedAhead();
  std::cerr << prompt << " " << std::flush;
  own.prompt_ = prompt.substr(prompt.rfind('\n') + 1);
  own.RunUntil([&own] { return own.HasLine() || own.ended_; }, kAskS);
  own.prompt_.clear();
  if (own.end_.asked()) return Interrupted();
  if (own.HasLine() || !own.typed_.empty()) return own.TakeLine();
  return Failure(
      "the standard input has ended, so nobody can answer; run the command again in a terminal");
}

void Console::ReadKeys(bool on) {
  implementation_->Open();
  implementation_->ReadKeys(on);
}

std::optional<char> Console::TakeKey() {
  std::string& typed = implementation_->typed_;
  if (typed.empty()) return std::nullopt;
  const char key = typed.front();
  typed.erase(0, 1);
  return key;
}

std::optional<std::string> Console::TakeLine() {
  if (!implementation_->HasLine()) return std::nullopt;
  return implementation_->TakeLine();
}

void Console::DropTypedAhead() { implementation_->DropTypedAhead(); }

Waited Console::RunUntil(const std::function<bool()>& condition, double within_s) {
  return implementation_->RunUntil(condition, within_s);
}

bool Console::interrupted() const { return implementation_->end_.asked(); }

Error Interrupted() { return Failure("interrupted; footing-study run resumes the session"); }

}  // namespace footing::study
