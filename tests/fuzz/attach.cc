#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <set>
#include <string>

#include "common/net/framing.h"
#include "common/runtime/timer.h"
#include "daemon/sensor/devices/socket_source.h"
#include "footing/v1/device.pb.h"
#include "tests/fuzz/message.h"
#include "tests/fuzz/simulated_time.h"

/// The device socket, to which two programs send anything at any time: bytes, messages of every
/// kind, or nothing for seconds. Only a device that is attached reports, each that was attached
/// ends, and what comes back is frames of the server's messages.
namespace footing::fuzz {
namespace {

using devices::DeviceHandle;

const std::string& Folder() {
  static const std::string folder = [] {
    std::string name = "/tmp/footing-fuzz-XXXXXX";
    Expect(mkdtemp(name.data()) != nullptr);
    return name;
  }();
  return folder;
}

transport::Address Here() {
  transport::Address address;
  address.path = Folder() + "/s";
  return address;
}

int Dialled() {
  const int made = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = Here().path;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  Expect(::connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  return made;
}

/// A program that simulates devices.
struct Program {
  RawPeer peer;
  transport::FrameSplitter splitter{1 << 16};
};

class Socket {
 public:
  Socket()
      : source_(
            io_, Here(), [this] { return ++last_; }, Handlers()) {
    Expect(source_.Start().ok());
    for (Program& program : programs_) program.peer.Take(Dialled());
    RunFor(io_, 0);
  }
  ~Socket() {
    source_.Stop();
    timer::DropWaits();
  }

  void Step(Input& input) {
    const std::uint8_t what = input.Byte();
    Program& program = programs_[what / 128];
    switch (what % 8) {
      case 0: {
        const Bytes bytes = input.String();
        return program.peer.Write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }
      case 1:
      case 2: {
        v1::DeviceEnvelope message;
        Fill(input, message);
        return Send(program, message);
      }
      case 3:
        return Attach(program, input.Byte());
      case 4:
        return Report(program, input);
      case 5:
        return Leave(program, input.Byte());
      case 6:
        return RunFor(io_, time_.Take(0.1 * input.Byte()));
      default:
        return Answer(input.Byte());
    }
  }

  void End() {
    for (Program& program : programs_) {
      Look(program);
      program.peer.Close();
    }
    RunFor(io_, 1, [this] { return attached_.empty(); });
    Expect(attached_.empty());
  }

 private:
  devices::SourceHandlers Handlers() {
    devices::SourceHandlers handlers;
    handlers.on_attach = [this](DeviceHandle device, const devices::DeviceIdentity& identity) {
      Expect(identity.simulated && !identity.serial.empty() && identity.serial.size() <= 64);
      if (identity.serial == "taken") return std::string("there is one already");
      attached_.insert(device);
      Expect(attached_.size() <= programs_.size() * devices::SocketSource::kMaxSlots);
      return std::string();
    };
    handlers.on_report = [this](DeviceHandle device, const devices::IncomingReport& report) {
      Expect(attached_.contains(device) && report.bytes.size() <= transport::kMaxDeviceBytes);
    };
    handlers.on_detach = [this](DeviceHandle device, const std::string&) {
      Expect(attached_.erase(device) == 1);
    };
    handlers.on_hands = [](std::int64_t, const stream::HandFrame&) {};
    handlers.on_reference = [](std::int64_t, const stream::ReferenceFrame&) {};
    handlers.on_contacts = [](std::int64_t, const stream::ContactFrame&) {};
    handlers.on_trouble = [](const std::string& line) { Expect(line.size() < 1000); };
    return handlers;
  }

  void Send(Program& program, const v1::DeviceEnvelope& message) {
    program.peer.Write(transport::Frame(message.SerializeAsString()));
    RunFor(io_, 0);
  }

  void Attach(Program& program, std::uint8_t how) {
    v1::DeviceEnvelope message;
    v1::DeviceAttach& attach = *message.mutable_attach();
    attach.set_slot(how % 20);
    attach.set_vendor(devices::kVendorNintendo);
    attach.set_product(devices::kProductFirst);
    attach.set_serial(how >= 200 ? "taken" : std::to_string(how));
    Send(program, message);
  }

  void Report(Program& program, Input& input) {
    v1::DeviceEnvelope message;
    message.mutable_input_report()->set_slot(input.Byte() % 20);
    const Bytes bytes = input.String();
    message.mutable_input_report()->set_report(bytes.data(), bytes.size());
    Send(program, message);
  }

  void Leave(Program& program, std::uint8_t how) {
    v1::DeviceEnvelope message;
    if ((how & 32) != 0) message.mutable_fault()->set_slot(how % 20);
    if ((how & 32) == 0) message.mutable_detach()->set_slot(how % 20);
    Send(program, message);
    if (how >= 250) program.peer.EndWriting();
  }

  /// Acts of the hub's own accord, with a device that there is or was.
  void Answer(std::uint8_t how) {
    const DeviceHandle device = how / 4;
    if (how % 4 == 0) return source_.Send(device, {0x15, 0x00});
    if (how % 4 == 1) return source_.RequestFeature(device, how, 49);
    if (how % 4 == 2) {
      for (Program& program : programs_) Look(program);
      return;
    }
    // The hub forgets the device that it does not take any more.
    if (attached_.erase(device) == 1) source_.Refuse(device, "a real device takes its place");
  }

  void Look(Program& program) {
    RunFor(io_, 0);
    const auto fed = program.splitter.Feed(program.peer.Read(), [](std::string_view payload) {
      v1::DeviceEnvelope message;
      Expect(message.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
      Expect(message.has_output() || message.has_refused());
      return true;
    });
    Expect(fed.ok());
  }

  boost::asio::io_context io_;
  DeviceHandle last_ = 0;
  std::set<DeviceHandle> attached_;
  devices::SocketSource source_;
  std::array<Program, 2> programs_;
  TimeBudget time_;
};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::FollowSimulatedTime();
  fuzz::Input input(data, size);
  fuzz::Socket socket;
  while (!input.empty()) socket.Step(input);
  socket.End();
  return 0;
}
