#include "daemon/offline/bench/broker_link.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include "common/runtime/clock.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
namespace {

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  at.sin_port = htons(port);
  return at;
}

std::uint16_t FreePort() {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at = Loopback(0);
  socklen_t size = sizeof(at);
  const bool bound = bind(probe, reinterpret_cast<sockaddr*>(&at), sizeof(at)) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  close(probe);
  return bound ? ntohs(at.sin_port) : 0;
}

bool Listens(std::uint16_t port) {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in at = Loopback(port);
  const bool connected = connect(probe, reinterpret_cast<const sockaddr*>(&at), sizeof(at)) == 0;
  close(probe);
  return connected;
}

/// Debian has servers where an ordinary user's PATH does not look.
std::string Find(const std::string& program) {
  for (const char* const folder : {"/usr/sbin/", "/usr/bin/", "/usr/local/sbin/"}) {
    if (access((folder + program).c_str(), X_OK) == 0) return folder + program;
  }
  return "";
}

}  // namespace

const char* NameOf(BrokerKind kind) {
  return kind == BrokerKind::kNats ? "nats-server" : "mosquitto";
}

std::unique_ptr<Broker> Broker::Start(BrokerKind kind) {
  const std::string program = Find(NameOf(kind));
  if (program.empty()) {
    std::cerr << "left out: " << NameOf(kind) << " is not installed" << std::endl;
    return nullptr;
  }
  std::unique_ptr<Broker> broker(new Broker(kind));
  broker->address_ = TcpAddress();
  broker->address_.port = FreePort();
  if (!broker->Spawn(program)) {
    std::cerr << "left out: " << program << " does not start" << std::endl;
    return nullptr;
  }
  return broker;
}

bool Broker::Spawn(const std::string& program) {
  const std::string port = std::to_string(address_.port);
  std::vector<std::string> words = {program, "-a", "127.0.0.1", "-p", port};
  if (kind_ == BrokerKind::kMosquitto) {
    config_ = "/tmp/footing-bench-" + std::to_string(getpid()) + "-mosquitto.conf";
    // By default it would drop what is more than 1000 messages behind.
    std::ofstream(config_) << "listener " << port << " 127.0.0.1\nallow_anonymous true\n"
                           << "persistence false\nmax_queued_messages 0\nset_tcp_nodelay true\n";
    words = {program, "-c", config_};
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  const int error =
      posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    process_ = -1;
    return false;
  }
  constexpr int kTries = 500;
  constexpr std::int64_t kPauseNs = 10'000'000;
  for (int i = 0; i < kTries; ++i) {
    if (Listens(address_.port)) return true;
    clock::SleepUntil(clock::MonotonicNs() + kPauseNs);
  }
  return false;
}

Broker::~Broker() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (!config_.empty()) std::remove(config_.c_str());
}

double Broker::CpuSeconds() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  double user = 0, system = 0;
  // Behind the name: state is the first, utime and stime the 12th and 13th.
  for (int i = 0; i < 11; ++i) fields >> skipped;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

namespace {

constexpr std::string_view kTopic = "t";
// Control packets of MQTT 3.1.1, sections 3.1 to 3.9.
constexpr char kConnect = 0x10, kPublish = 0x30;
constexpr auto kSubscribe = static_cast<char>(0x82);
constexpr unsigned char kConnectAnswer = 0x20, kSubscribeAnswer = 0x90;

std::string Text(std::string_view text) {
  std::string bytes = {static_cast<char>(text.size() >> 8), static_cast<char>(text.size())};
  return bytes.append(text);
}

std::string Packet(char kind, std::string_view body) {
  std::string bytes(1, kind);
  for (std::size_t left = body.size();; left /= 128) {
    bytes += static_cast<char>(left % 128 | (left >= 128 ? 0x80 : 0));
    if (left < 128) break;
  }
  return bytes.append(body);
}

std::string Greeting(BrokerKind kind, BrokerLink::Part part, int number) {
  const bool subscribes = part == BrokerLink::Part::kSubscribes;
  if (kind == BrokerKind::kNats) {
    return "CONNECT {\"verbose\":false,\"pedantic\":false}\r\n" +
           std::string(subscribes ? "SUB t 1\r\n" : "") + "PING\r\n";
  }
  const std::string options("\x04\x02\x00\x00", 4);  // 3.1.1, a clean session, no keep-alive.
  std::string bytes = Packet(kConnect, Text("MQTT") + options + Text("b" + std::to_string(number)));
  if (subscribes) bytes += Packet(kSubscribe, std::string("\0\1", 2) + Text(kTopic) + '\0');
  return bytes;
}

/// Message at the front of the received bytes.
struct Front {
  std::size_t size = 0;  ///< 0: more must come.
  std::optional<std::string_view> payload;
  bool ready = false;
};

Front LookAtNats(std::string_view bytes) {
  const std::size_t end = bytes.find("\r\n");
  if (end == std::string_view::npos) return {};
  const std::string_view line = bytes.substr(0, end);
  if (line.starts_with("PONG")) return {end + 2, {}, true};
  if (!line.starts_with("MSG ")) return {end + 2, {}, false};
  std::size_t size = 0;
  const std::size_t number = line.rfind(' ') + 1;
  std::from_chars(line.data() + number, line.data() + line.size(), size);
  if (bytes.size() < end + 2 + size + 2) return {};
  return {end + 2 + size + 2, bytes.substr(end + 2, size), false};
}

Front LookAtMqtt(std::string_view bytes, BrokerLink::Part part) {
  std::size_t size = 0, at = 1;
  for (int shift = 0;; shift += 7) {
    if (at >= bytes.size()) return {};
    const auto byte = static_cast<unsigned char>(bytes[at++]);
    size |= std::size_t{byte & 0x7fu} << shift;
    if (byte < 0x80) break;
  }
  if (bytes.size() < at + size) return {};
  const auto kind = static_cast<unsigned char>(bytes[0]);
  const bool subscribes = part == BrokerLink::Part::kSubscribes;
  if ((kind & 0xf0) != kPublish) {
    return {at + size, {}, kind == (subscribes ? kSubscribeAnswer : kConnectAnswer)};
  }
  const std::size_t topic = 2 + kTopic.size();
  return {at + size, bytes.substr(at + topic, size - topic), false};
}

}  // namespace

class BrokerLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(BrokerKind kind, Part part, std::function<void(std::string_view)> on_payload)
      : kind_(kind), part_(part), on_payload_(std::move(on_payload)) {}

  void Dial(boost::asio::io_context& io, const Broker& broker, int number) {
    transport::Dial(io, broker.address(),
                    [self = shared_from_this(), number](Result<transport::Socket> socket) {
                      if (!socket) return;  // It shows as not ready.
                      self->socket_.emplace(std::move(*socket));
                      transport::Prepare(*self->socket_);
                      self->Send(Greeting(self->kind_, self->part_, number));
                      self->Read();
                    });
  }

  void Publish(std::string_view payload) {
    if (kind_ == BrokerKind::kMosquitto) {
      return Send(Packet(kPublish, Text(kTopic).append(payload)));
    }
    std::string bytes = "PUB t " + std::to_string(payload.size()) + "\r\n";
    Send(bytes.append(payload).append("\r\n"));
  }

  void Close() {
    if (socket_) socket_->Close();
  }

  bool ready() const { return ready_; }

 private:
  void Send(std::string_view bytes) {
    if (!socket_) return;
    queued_.append(bytes);
    if (writing_.empty()) Write();
  }

  void Write() {
    writing_ = std::exchange(queued_, {});
    if (writing_.empty()) return;
    boost::asio::async_write(
        socket_->plain(), boost::asio::buffer(writing_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
          self->writing_.clear();
          if (!error) self->Write();
        });
  }

  void Read() {
    socket_->plain().async_read_some(
        boost::asio::buffer(in_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t count) {
          if (error) return;
          self->Take({self->in_.data(), count});
          self->Read();
        });
  }

  void Take(std::string_view bytes) {
    if (!rest_.empty()) {
      rest_.append(bytes);
      bytes = rest_;
    }
    while (bytes.size() > 1) {
      const Front front = kind_ == BrokerKind::kNats ? LookAtNats(bytes) : LookAtMqtt(bytes, part_);
      if (front.size == 0) break;
      if (front.ready) ready_ = true;
      if (front.payload && on_payload_) on_payload_(*front.payload);
      bytes.remove_prefix(front.size);
    }
    rest_ = std::string(bytes);
  }

  BrokerKind kind_;
  Part part_;
  std::function<void(std::string_view)> on_payload_;
  std::optional<transport::Socket> socket_;
  std::array<char, 16 << 10> in_;
  std::string rest_, queued_, writing_;
  bool ready_ = false;
};

BrokerLink::BrokerLink(boost::asio::io_context& io, const Broker& broker, Part part, int number,
                       std::function<void(std::string_view)> on_payload)
    : implementation_(
          std::make_shared<Implementation>(broker.kind(), part, std::move(on_payload))) {
  implementation_->Dial(io, broker, number);
}
BrokerLink::~BrokerLink() { implementation_->Close(); }

bool BrokerLink::ready() const { return implementation_->ready(); }
void BrokerLink::Publish(std::string_view payload) { implementation_->Publish(payload); }

namespace {

// liblsl's lsl_c.h: cft_string, nominal_srate of 0 for an irregular rate, seconds.
constexpr int kStringFormat = 3;
constexpr double kIrregularRate = 0;
constexpr double kConnectS = 5;
constexpr double kPullS = 0.2;
constexpr int kBufferedS = 60;

template <typename Function>
bool Load(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace

/// The functions used of liblsl's C interface; its handles are pointers.
struct LslLink::Library {
  void* handle = nullptr;
  void* (*create_info)(const char*, const char*, std::int32_t, double, int, const char*) = nullptr;
  void (*destroy_info)(void*) = nullptr;
  std::int32_t (*resolve)(void**, std::uint32_t, const char*, const char*, std::int32_t,
                          double) = nullptr;
  void* (*create_outlet)(void*, std::int32_t, std::int32_t) = nullptr;
  void (*destroy_outlet)(void*) = nullptr;
  std::int32_t (*push)(void*, const char**, const std::uint32_t*) = nullptr;
  void* (*create_inlet)(void*, std::int32_t, std::int32_t, std::int32_t) = nullptr;
  void (*destroy_inlet)(void*) = nullptr;
  void (*open)(void*, double, std::int32_t*) = nullptr;
  double (*pull)(void*, char**, std::uint32_t*, std::int32_t, double, std::int32_t*) = nullptr;
  void (*destroy_string)(char*) = nullptr;

  bool LoadAll() {
    for (const char* const name : {"liblsl.so.2", "liblsl.so"}) {
      if (handle == nullptr) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
    return handle != nullptr && Load(handle, "lsl_create_streaminfo", create_info) &&
           Load(handle, "lsl_destroy_streaminfo", destroy_info) &&
           Load(handle, "lsl_resolve_byprop", resolve) &&
           Load(handle, "lsl_create_outlet", create_outlet) &&
           Load(handle, "lsl_destroy_outlet", destroy_outlet) &&
           Load(handle, "lsl_push_sample_buf", push) &&
           Load(handle, "lsl_create_inlet", create_inlet) &&
           Load(handle, "lsl_destroy_inlet", destroy_inlet) &&
           Load(handle, "lsl_open_stream", open) && Load(handle, "lsl_pull_sample_buf", pull) &&
           Load(handle, "lsl_destroy_string", destroy_string);
  }
};

std::unique_ptr<LslLink> LslLink::Start(std::function<void(std::string_view)> on_payload) {
  auto library = std::make_unique<Library>();
  if (!library->LoadAll()) {
    std::cerr << "left out: liblsl is not installed" << std::endl;
    return nullptr;
  }
  std::unique_ptr<LslLink> link(new LslLink(std::move(library), std::move(on_payload)));
  if (!link->Connect()) {
    std::cerr << "left out: an inlet of liblsl does not find its outlet" << std::endl;
    return nullptr;
  }
  return link;
}

LslLink::LslLink(std::unique_ptr<Library> library,
                 std::function<void(std::string_view payload)> on_payload)
    : library_(std::move(library)), on_payload_(std::move(on_payload)) {}

LslLink::~LslLink() {
  stop_.Raise();
  if (thread_.joinable()) thread_.join();
  if (inlet_ != nullptr) library_->destroy_inlet(inlet_);
  if (outlet_ != nullptr) library_->destroy_outlet(outlet_);
}

bool LslLink::Connect() {
  const std::string id = "footing-bench-" + std::to_string(getpid());
  void* const info =
      library_->create_info("footing-bench", "ticks", 1, kIrregularRate, kStringFormat, id.c_str());
  if (info == nullptr) return false;
  outlet_ = library_->create_outlet(info, 0, kBufferedS);
  library_->destroy_info(info);
  void* found = nullptr;
  if (outlet_ == nullptr ||
      library_->resolve(&found, 1, "source_id", id.c_str(), 1, kConnectS) < 1) {
    return false;
  }
  inlet_ = library_->create_inlet(found, kBufferedS, 0, 0);
  library_->destroy_info(found);
  if (inlet_ == nullptr) return false;
  std::int32_t error = 0;
  library_->open(inlet_, kConnectS, &error);
  if (error != 0) return false;
  thread_ = std::thread([this] { PullOnThread(); });
  return true;
}

void LslLink::Publish(std::string_view payload) {
  const char* samples[] = {payload.data()};
  const std::uint32_t lengths[] = {static_cast<std::uint32_t>(payload.size())};
  library_->push(outlet_, samples, lengths);
}

void LslLink::PullOnThread() {
  while (!stop_.raised()) {
    char* sample = nullptr;
    std::uint32_t length = 0;
    std::int32_t error = 0;
    library_->pull(inlet_, &sample, &length, 1, kPullS, &error);
    if (sample == nullptr) continue;
    on_payload_(std::string_view(sample, length));
    library_->destroy_string(sample);
  }
}

}  // namespace footing::bench
