#include "clients/stream/network_sensors.h"

#include <array>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/address_v4.hpp>
#include <boost/asio/ip/udp.hpp>

#include "clients/stream/sensor_packets.h"
#include "common/net/device_link.h"
#include "common/net/limits.h"
#include "common/net/socket.h"
#include "common/net/udp.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"
#include "common/stream/device.h"
#include "common/stream/product_ids.h"
#include "footing/v1/device.pb.h"

namespace footing::stream_client {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;

constexpr std::int64_t kGoneNs = 5'000'000'000;
constexpr double kMostPacketsPerS = 10'000;
constexpr int kMostAtOnce = 64;  // Packets before the other work of this thread has its turn.
constexpr std::int64_t kQuietNs = 10'000'000'000;  // Between two lines on packets that are unknown.

/// Roles as they were asked for: by the name of a sensor, and for the others in turn.
struct Roles {
  std::map<std::string, stream::DeviceRole> by_sensor;
  std::vector<stream::DeviceRole> in_turn;

  static Result<Roles> Of(const std::vector<std::string>& texts) {
    Roles roles;
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      const std::string name = equals == std::string::npos ? text : text.substr(equals + 1);
      const stream::DeviceRole role = stream::RoleNamed(name);
      if (role == stream::DeviceRole::kUnspecified) {
        std::string known;
        for (const auto one : stream::kDeviceRoles) known += std::string(" ") + stream::Name(one);
        return UsageError("--role " + text + ": unknown role \"" + name + "\"; there are" + known);
      }
      if (equals == std::string::npos) {
        roles.in_turn.push_back(role);
      } else {
        roles.by_sensor[text.substr(0, equals)] = role;
      }
    }
    return roles;
  }
};

/// Without the prefix under which an IPv6 socket sees those of IPv4.
std::string NameOf(const asio::ip::address& sender) {
  if (!sender.is_v6() || !sender.to_v6().is_v4_mapped()) return sender.to_string();
  return asio::ip::make_address_v4(asio::ip::v4_mapped, sender.to_v6()).to_string();
}

class Receiver {
 public:
  Receiver(const SensorsOptions& options, Roles roles, const transport::Address& to)
      : options_(options),
        roles_(std::move(roles)),
        link_(io_, {.to = to,
                    .client_name = "footing-stream sensors",
                    .on_open = [this] { AttachAll(); },
                    .on_close = [] { log::Warning("footingd is gone; waiting for it"); }}) {}

  Result<void> Run(double seconds) {
    const auto at = transport::ParseUdp(options_.listen, "--listen");
    if (!at) return at.error();
    boost::system::error_code error;
    socket_.open(at->protocol(), error);
    if (!error) socket_.bind(*at, error);
    if (!error) socket_.non_blocking(true, error);
    if (error) {
      return Failure("cannot listen on UDP " + options_.listen + ": " +
                     transport::MessageOf(error) + "; choose another port with --listen");
    }
    std::ostringstream bound;
    bound << socket_.local_endpoint(error);
    log::Info("listening for sensors on UDP " + bound.str());
    link_.Start();
    end_.After(seconds, [this] {
      if (!link_.was_open()) result_ = link_.NeverOpen();
      End();
    });
    ReceiveLater();
    CleanLater();
    io_.run();
    return result_;
  }

 private:
  struct Sensor {
    std::uint32_t slot = 0;
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    std::int64_t newest_ns = 0;
    std::uint64_t sequence = 0;
  };

  void ReceiveLater() {
    socket_.async_wait(udp::socket::wait_read, [this](const boost::system::error_code& failed) {
      if (failed) return;
      for (int i = 0; i < kMostAtOnce && Receive(); ++i) {
      }
      ReceiveLater();
    });
  }

  bool Receive() {
    udp::endpoint from;
    boost::system::error_code error;
    const std::size_t size = socket_.receive_from(asio::buffer(bytes_), from, 0, error);
    if (error) return false;  // No packet is waiting.
    const std::int64_t now_ns = clock::MonotonicNs();
    if (!bucket_.Spend(now_ns)) return true;
    const std::string sender = NameOf(from.address());
    const SensorPacket packet = packets_.Take(sender, now_ns, {bytes_.data(), size});
    for (const std::string& reply : packet.replies) {
      socket_.send_to(asio::buffer(reply), from, 0, error);
    }
    for (const SensorReport& one : packet.reports) Publish(one, now_ns);
    if (!packet.is_known && now_ns - said_unknown_ns_ > kQuietNs) {
      said_unknown_ns_ = now_ns;
      log::Warning("a packet from " + sender +
                   " is of none of the protocols that are known; see footing-stream sensors "
                   "--help");
    }
    return true;
  }

  void Publish(const SensorReport& one, std::int64_t now_ns) {
    auto known = sensors_.find(one.sensor);
    if (known == sensors_.end()) known = Arrived(one.sensor);
    Sensor& sensor = known->second;
    sensor.newest_ns = now_ns;
    v1::DeviceEnvelope envelope;
    v1::DeviceInputReport& report = *envelope.mutable_input_report();
    report.set_slot(sensor.slot);
    report.set_sequence(++sensor.sequence);
    report.set_report(one.report.data(), one.report.size());
    link_.Send(envelope);
  }

  std::map<std::string, Sensor>::iterator Arrived(const std::string& name) {
    Sensor sensor;
    sensor.slot = ++last_slot_;
    if (const auto named = roles_.by_sensor.find(name); named != roles_.by_sensor.end()) {
      sensor.role = named->second;
    } else if (!roles_.in_turn.empty()) {
      sensor.role = roles_.in_turn.front();
      roles_.in_turn.erase(roles_.in_turn.begin());
      roles_.by_sensor[name] = sensor.role;  // The same one when it comes back.
    }
    const bool has_role = sensor.role != stream::DeviceRole::kUnspecified;
    log::Info("sensor " + name +
              (has_role ? std::string(": ") + stream::Name(sensor.role)
                        : ", without a role: give it one with --role"));
    const auto added = sensors_.emplace(name, sensor).first;
    Attach(name, added->second);
    return added;
  }

  void Attach(const std::string& name, const Sensor& sensor) {
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(sensor.slot);
    attach.set_vendor(stream::kVendorFooting);
    attach.set_product(stream::kProductInertial);
    attach.set_name("sensor at " + name);
    attach.set_serial(name);
    attach.set_rig(options_.rig);
    attach.set_role(static_cast<v1::DeviceRole>(sensor.role));
    attach.set_hardware(true);
    link_.Send(envelope);
  }

  void AttachAll() {
    for (const auto& [name, sensor] : sensors_) Attach(name, sensor);
  }

  void CleanLater() {
    clean_.After(1, [this] {
      const std::int64_t now_ns = clock::MonotonicNs();
      std::erase_if(sensors_, [&](const auto& entry) {
        const auto& [name, sensor] = entry;
        if (now_ns - sensor.newest_ns < kGoneNs) return false;
        log::Info("sensor " + name + " is silent; detached");
        v1::DeviceEnvelope envelope;
        envelope.mutable_detach()->set_slot(sensor.slot);
        link_.Send(envelope);
        packets_.Forget(name);
        return true;
      });
      CleanLater();
    });
  }

  void End() {
    boost::system::error_code ignored;
    socket_.close(ignored);
    clean_.cancel();
    end_.cancel();
    link_.Stop("stopped");
  }

  const SensorsOptions options_;
  Roles roles_;
  asio::io_context io_{1};
  device_link::DeviceLink link_;
  service_manager::ProgramEnd end_{io_, [this] { End(); }};
  udp::socket socket_{io_};
  timer::Timer clean_{io_};
  transport::TokenBucket bucket_{kMostPacketsPerS, kMostPacketsPerS / 10};
  SensorPackets packets_;
  std::array<std::uint8_t, SensorPackets::kMostPacketBytes + 1> bytes_;
  std::map<std::string, Sensor> sensors_;
  std::uint32_t last_slot_ = 0;
  std::int64_t said_unknown_ns_ = -kQuietNs;
  Result<void> result_;
};

}  // namespace

CLI::App* AddSensorsCommand(CLI::App& app, SensorsOptions& options) {
  auto* sensors = app.add_subcommand(
      "sensors",
      "Real inertial sensors of the network: SlimeVR trackers, phones with Sensors2OSC or ZIG SIM, "
      "boards of your own (docs/devices.md)");
  sensors->add_option("--listen", options.listen, "UDP address, HOST:PORT or [IPv6]:PORT");
  sensors->add_option("--role", options.roles,
                      "Role of the next sensor that comes, or SENSOR=ROLE; may be repeated");
  sensors->add_option("--rig", options.rig, "Rig of the sensors (default: as footingd's config)");
  return sensors;
}

Result<void> RunSensors(const SensorsOptions& options, const transport::Address& to,
                        double seconds) {
  auto roles = Roles::Of(options.roles);
  if (!roles) return roles.error();
  return std::make_unique<Receiver>(options, std::move(roles).value(), to)->Run(seconds);
}

}  // namespace footing::stream_client
