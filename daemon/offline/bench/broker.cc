#include "daemon/offline/bench/broker.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>

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

}  // namespace footing::bench
