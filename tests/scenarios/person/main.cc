// scenario_person DEVICE_SOCKET [--low-battery]: two boards and two wrist remotes under a person
// who does what the lines of standard input say (see body.h), and "replug": the left remote goes
// away for a second.
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/streambuf.hpp>
#include <iostream>
#include <memory>

#include "clients/stream/dialer.h"
#include "common/log/log.h"
#include "common/transport/address.h"
#include "tests/scenarios/person/body.h"

namespace {

using namespace footing;  // NOLINT: a program of one file
namespace asio = boost::asio;
using stream_client::Dialer;
using stream_client::StandIn;

constexpr std::uint8_t kExhausted = 0x08;  // Of a Wiimote's battery; full is 0xc8.

class Person {
 public:
  Person(asio::io_context& io, transport::Address to, bool low_battery)
      : io_(io), to_(std::move(to)), low_battery_(low_battery), in_(io, 0), away_(io) {
    for (int slot = 0; slot < 4; ++slot) Attach(slot);
    Listen();
  }

 private:
  void Attach(int slot) {
    using device_models::LinkQuality;
    const bool board = slot < 2;
    const int side = slot % 2;
    const auto seed = static_cast<std::uint64_t>(100 + slot);
    std::vector<StandIn> one;
    if (board) {
      one.emplace_back(
          device_models::BalanceBoard(seed),
          [this, side](double t_s) { return body_.Board(side, t_s); },
          side == 0 ? stream::DeviceRole::kLeftBoard : stream::DeviceRole::kRightBoard,
          device_models::BoardLink(LinkQuality::kGood, seed));
    } else {
      device_models::Wiimote wiimote(seed);
      if (low_battery_ && side == 1) wiimote.controller().set_battery(kExhausted);
      one.emplace_back(
          std::move(wiimote), [this, side](double t_s) { return body_.Hand(side, t_s); },
          side == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand,
          device_models::WiimoteLink(LinkQuality::kGood, seed));
    }
    dialers_[static_cast<std::size_t>(slot)] = std::make_unique<Dialer>(
        io_, stream_client::DialerOptions{to_, 1, 0}, std::move(one), [] {});
    dialers_[static_cast<std::size_t>(slot)]->Start();
  }

  void Replug() {
    constexpr int kLeftRemote = 2;
    dialers_[kLeftRemote]->Stop("switched off");
    away_.expires_after(std::chrono::seconds(1));
    away_.async_wait([this](const boost::system::error_code& error) {
      if (!error) Attach(kLeftRemote);
    });
  }

  void Listen() {
    asio::async_read_until(
        in_, text_, '\n', [this](const boost::system::error_code& error, std::size_t) {
          if (error) return io_.stop();
          std::istream stream(&text_);
          std::string line;
          std::getline(stream, line);
          if (line == "replug") {
            Replug();
          } else if (!body_.Tell(line)) {
            std::cerr << "error: the person does not know: " << line << std::endl;
          }
          Listen();
        });
  }

  asio::io_context& io_;
  transport::Address to_;
  bool low_battery_;
  scenario::Body body_;
  asio::posix::stream_descriptor in_;
  asio::streambuf text_;
  asio::steady_timer away_;
  std::array<std::unique_ptr<Dialer>, 4> dialers_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto to = transport::ParseAddress(argv[1]);
  if (!to) {
    std::cerr << "error: " << to.error().message << std::endl;
    return 2;
  }
  log::Start("scenario_person", false);
  asio::io_context io(1);
  Person person(io, *to, argc > 2 && std::string(argv[2]) == "--low-battery");
  io.run();
  return 0;
}
