// scenario_person DEVICE_SOCKET [--shins] [--jumbled] [--low-battery]: two boards and two remotes,
// on the wrists or the shins, under a person who does what the lines of standard input say: those
// of SetupBody::Do, "on" (switches all devices on) and "replug" (the left remote goes away for a
// second). Jumbled devices ask for the other side's roles, as if they had been switched on in the
// wrong order.
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/streambuf.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "clients/stream/body_stage.h"
#include "clients/stream/dialer.h"
#include "common/net/address.h"
#include "common/runtime/log.h"

namespace {

using namespace footing;  // NOLINT: a program of one file
namespace asio = boost::asio;
using stream::DeviceRole;
using stream_client::Dialer;
using stream_client::SimulatedDevice;
using virtual_devices::LinkQuality;

constexpr std::uint8_t kExhausted = 0x08;  // Level of a Wiimote's battery; full is 0xc8.
constexpr std::size_t kLeftRemote = 2;     // Slots: left board, right board, left and right remote.

struct Options {
  transport::Address to;
  stream_client::SetupBody::Place worn = stream_client::SetupBody::Place::kWrists;
  bool jumbled = false;
  bool low_battery = false;
};

class Person {
 public:
  Person(asio::io_context& io, Options options)
      : io_(io), options_(std::move(options)), body_(options_.worn), in_(io, 0), away_(io) {
    Listen();
  }

 private:
  SimulatedDevice Board(int side, std::uint64_t seed) {
    const bool left = (side == 0) != options_.jumbled;
    return {virtual_devices::BalanceBoard(seed),
            [this, side](double t_s) { return body_.Board(side, t_s); },
            left ? DeviceRole::kLeftBoard : DeviceRole::kRightBoard,
            virtual_devices::BoardLink(LinkQuality::kGood, seed)};
  }

  SimulatedDevice Remote(int side, std::uint64_t seed) {
    virtual_devices::Wiimote wiimote(seed);
    if (options_.low_battery && side == 1) wiimote.controller().set_battery(kExhausted);
    const auto feels = [this, side](double t_s) {
      virtual_devices::WiimoteSensors sensors;
      sensors.specific_force_S_mps2 = body_.Limb(side, t_s);
      return sensors;
    };
    return {std::move(wiimote), feels, body_.Role(options_.jumbled ? 1 - side : side),
            virtual_devices::WiimoteLink(LinkQuality::kGood, seed)};
  }

  void SwitchOn(std::size_t slot) {
    if (dialers_[slot]) return;
    const auto seed = static_cast<std::uint64_t>(100 + slot);
    const int side = static_cast<int>(slot % 2);
    stream_client::Plan one;
    one.devices.push_back(slot < kLeftRemote ? Board(side, seed) : Remote(side, seed));
    dialers_[slot] = std::make_unique<Dialer>(io_, stream_client::DialerOptions{options_.to, 1},
                                              std::move(one), [] {});
    dialers_[slot]->Start();
  }

  void Replug() {
    if (!dialers_[kLeftRemote]) return;
    dialers_[kLeftRemote]->Stop("switched off");
    away_.expires_after(std::chrono::seconds(1));
    away_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      dialers_[kLeftRemote].reset();
      SwitchOn(kLeftRemote);
    });
  }

  void Listen() {
    asio::async_read_until(in_, text_, '\n',
                           [this](const boost::system::error_code& error, std::size_t) {
                             if (error) return io_.stop();
                             std::istream stream(&text_);
                             std::string line;
                             std::getline(stream, line);
                             Obey(line);
                             Listen();
                           });
  }

  void Obey(const std::string& line) {
    if (line == "on") {
      for (std::size_t slot = 0; slot < dialers_.size(); ++slot) SwitchOn(slot);
    } else if (line == "replug") {
      Replug();
    } else if (!body_.Do(line)) {
      std::cerr << "error: the person does not know: " << line << std::endl;
    }
  }

  asio::io_context& io_;
  Options options_;
  stream_client::SetupBody body_;
  asio::posix::stream_descriptor in_;
  asio::streambuf text_;
  asio::steady_timer away_;
  std::array<std::unique_ptr<Dialer>, 4> dialers_;
};

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto to = transport::ParseAddress(words.empty() ? "" : words.front());
  if (!to) {
    std::cerr << "error: " << to.error().message << std::endl;
    return 2;
  }
  Options options;
  options.to = *to;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--shins") options.worn = stream_client::SetupBody::Place::kShins;
    if (words[i] == "--jumbled") options.jumbled = true;
    if (words[i] == "--low-battery") options.low_battery = true;
  }
  log::Start("scenario_person", false);
  asio::io_context io(1);
  Person person(io, std::move(options));
  io.run();
  return 0;
}
