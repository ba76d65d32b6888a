#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/plan/screen_message.h"
#include "clients/study/session/console.h"
#include "common/cli/cli.h"
#include "common/net/framed_connection.h"

namespace footing::study {
namespace {

constexpr auto kDialEvery = std::chrono::milliseconds(500);
constexpr double kForeverS = 365 * 24 * 3600;
constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

/// The survey as the participant sees it: one question at a time, answered with the keyboard.
class ScreenClient {
 public:
  ScreenClient(Console& console, transport::Address address)
      : console_(console), address_(std::move(address)), timer_(console.io()) {}

  /// Until the program is interrupted.
  void Run() {
    console_.ReadKeys(false);
    shown_.item = "Waiting for the experimenter.";
    Draw("");
    Dial();
    console_.RunUntil([this] { return TakeLine(), false; }, kForeverS);
  }

 private:
  void Dial() {
    transport::Dial(console_.io(), address_, [this](Result<transport::Socket> socket) {
      if (!socket) return DialLater();
      connection_ = std::make_unique<transport::FramedConnection>(
          std::move(*socket), transport::FramedLimits{.max_in_bytes = screen::kMostFrameBytes},
          transport::FramedHandlers{
              .on_frame = [this](std::string_view payload) { OnFrame(payload); },
              .on_close =
                  [this](const std::string&) {
                    shown_ = {.item = "Waiting for the experimenter."};
                    Draw("");
                    DialLater();
                  },
              .on_writable = {},
              .on_bytes = {},
              .on_bad_input = {}});
      connection_->Start();
    });
  }

  void DialLater() {
    timer_.expires_after(kDialEvery);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) Dial();
    });
  }

  void OnFrame(std::string_view payload) {
    auto shown = screen::ParseShown(payload);
    if (!shown) return;
    shown_ = std::move(*shown);
    console_.DropTypedAhead();
    Draw("");
  }

  void TakeLine() {
    const auto line = console_.TakeLine();
    if (!line || shown_.number == 0 || !connection_ || !connection_->open()) return;
    if (!screen::Answers(shown_, *line)) {
      return Draw(shown_.is_rating() ? "Type a number from " + std::to_string(shown_.least) +
                                           " to " + std::to_string(shown_.greatest) + "."
                                     : "Type one of them: the number or the name.");
    }
    connection_->Send(
        screen::ToText(screen::Reply{shown_.number, line->substr(0, screen::kMostAnswerBytes)}));
  }

  void Draw(const std::string& hint) {
    std::string text = kHomeAndClear;
    if (shown_.number == 0) return console_.Print(text + "\n\n  " + shown_.item + "\n");
    text += "\n  " + shown_.title + "   " + std::to_string(shown_.position) + " of " +
            std::to_string(shown_.count) + "\n\n  " + shown_.item + "\n\n";
    if (shown_.is_rating()) {
      for (int value = shown_.least; value <= shown_.greatest; ++value) {
        text += "    " + std::to_string(value);
      }
      text += "\n\n  " + shown_.scale + "\n\n";
    }
    for (std::size_t i = 0; i < shown_.choices.size(); ++i) {
      text += "    " + std::to_string(i + 1) + "  " + shown_.choices[i] + "\n";
    }
    if (!shown_.choices.empty()) text += "\n";
    text += hint.empty() ? "" : "  " + hint + "\n\n";
    const bool number = shown_.is_rating() || !shown_.choices.empty();
    console_.Print(
        text + (number ? "  Type a number and press Enter:" : "  Type one line and press Enter:"));
  }

  Console& console_;
  const transport::Address address_;
  boost::asio::steady_timer timer_;
  std::unique_ptr<transport::FramedConnection> connection_;
  screen::Shown shown_;
};

Result<void> ShowSurveys(const std::string& address) {
  const auto parsed = transport::ParseAddress(address);
  if (!parsed) return parsed.error();
  Console console;
  ScreenClient(console, *parsed).Run();
  return {};
}

}  // namespace

void AddSurveyCommand(CLI::App& app, Shared& shared) {
  const auto address = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "survey", "The participant's survey screen: a terminal that shows and answers the questions");
  command->add_option("--connect", *address, "Address of footing-study run --survey")->required();
  command->footer(
      "Examples:\n"
      "  footing-study run study.json --participant P01 --survey unix:/tmp/survey.sock\n"
      "  footing-study survey --connect unix:/tmp/survey.sock");
  command->callback([address, &shared] {
    if (const auto done = ShowSurveys(*address); !done)
      shared.exit_code = cli::Report(done.error());
  });
}

}  // namespace footing::study
