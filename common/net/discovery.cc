#include "common/net/discovery.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include <poll.h>
#include <systemd/sd-bus.h>
#include <unistd.h>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "common/net/socket.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"

namespace footing::discovery {

std::vector<std::string> TextRecord(const Service& service) {
  std::vector<std::string> record{"program=" + service.program};
  if (service.tls) record.push_back("tls=1");
  if (!service.fingerprint.empty()) record.push_back("fingerprint=" + service.fingerprint);
  return record;
}

void ReadTextRecord(const std::vector<std::string>& record, Service& service) {
  constexpr std::size_t kMostBytes = 80;  // A fingerprint has 71.
  for (const std::string& entry : record) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = entry.substr(0, equals);
    const std::string value = Printable(entry.substr(equals + 1), kMostBytes);
    if (key == "program") service.program = value;
    if (key == "tls") service.tls = value == "1";
    if (key == "fingerprint") service.fingerprint = value;
  }
}

std::string Printable(const std::string& text, std::size_t most_bytes) {
  std::string printable = text.substr(0, most_bytes);
  std::replace_if(
      printable.begin(), printable.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return printable;
}

namespace {

namespace asio = boost::asio;

constexpr const char* kGroup = "org.freedesktop.Avahi.EntryGroup";
// AVAHI_ENTRY_GROUP_ESTABLISHED and _COLLISION.
constexpr int kEstablished = 2, kCollision = 3;

}  // namespace

class Advertiser::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(asio::io_context& io, std::vector<Service> services)
      : services_(std::move(services)), readable_(io), writable_(io) {}
  ~Implementation() {
    if (readable_.is_open()) readable_.release();  // It is the bus's.
    sd_bus_flush_close_unref(bus_);
  }

  void Start() {
    if (const int error = sd_bus_open_system(&bus_); error < 0) {
      bus_ = nullptr;
      return NotAdvertised("no system bus: " + std::string(std::strerror(-error)));
    }
    sd_bus_match_signal_async(bus_, nullptr, "org.freedesktop.DBus", "/org/freedesktop/DBus",
                              "org.freedesktop.DBus", "NameOwnerChanged", &OnOwner, nullptr, this);
    sd_bus_match_signal_async(bus_, nullptr, kAvahi, nullptr, kGroup, "StateChanged", &OnState,
                              nullptr, this);
    readable_.assign(sd_bus_get_fd(bus_));
    writable_.assign(dup(sd_bus_get_fd(bus_)));
    AskForGroup();
    Process();
  }

  void Stop() {
    stopped_ = true;
    if (!readable_.is_open()) return;  // There is no bus.
    readable_.cancel();
    writable_.cancel();
  }

 private:
  void NotAdvertised(const std::string& why) {
    log::Warning("not advertised in the network (" + why + "); clients name the address");
  }

  void AskForGroup() {
    sd_bus_call_method_async(bus_, nullptr, kAvahi, "/", "org.freedesktop.Avahi.Server",
                             "EntryGroupNew", &OnGroup, this, "");
  }

  static int OnOwner(sd_bus_message* message, void* data, sd_bus_error*) {
    const char *name = nullptr, *before = nullptr, *now = nullptr;
    if (sd_bus_message_read(message, "sss", &name, &before, &now) < 0) return 0;
    auto* const self = static_cast<Implementation*>(data);
    if (std::strcmp(name, kAvahi) == 0 && *now != '\0') self->AskForGroup();
    return 0;
  }

  static int OnGroup(sd_bus_message* message, void* data, sd_bus_error*) {
    auto* const self = static_cast<Implementation*>(data);
    const char* path = nullptr;
    if (const sd_bus_error* error = sd_bus_message_get_error(message)) {
      self->NotAdvertised("avahi-daemon does not answer: " + std::string(error->message));
    } else if (sd_bus_message_read(message, "o", &path) >= 0) {
      self->group_ = path;
      for (const Service& service : self->services_) self->Add(service);
      sd_bus_call_method_async(self->bus_, nullptr, kAvahi, path, kGroup, "Commit", &OnDone, self,
                               "");
    }
    return 0;
  }

  void Add(const Service& service) {
    sd_bus_message* call = nullptr;
    if (sd_bus_message_new_method_call(bus_, &call, kAvahi, group_.c_str(), kGroup, "AddService") <
        0) {
      return;
    }
    if (Describe(service, call) < 0 ||
        sd_bus_call_async(bus_, nullptr, call, &OnDone, this, 0) < 0) {
      NotAdvertised("\"" + service.name + "\" is refused as a name");
    }
    sd_bus_message_unref(call);
  }

  /// Below 0 when the bus takes none of this.
  static int Describe(const Service& service, sd_bus_message* call) {
    const int head =
        sd_bus_message_append(call, "iiussssq", kAnyInterface, kAnyProtocol, 0u,
                              service.name.c_str(), kServiceType, "", "", service.port);
    if (head < 0) return head;
    sd_bus_message_open_container(call, 'a', "ay");
    for (const std::string& entry : TextRecord(service)) {
      sd_bus_message_append_array(call, 'y', entry.data(), entry.size());
    }
    return sd_bus_message_close_container(call);
  }

  static int OnDone(sd_bus_message* message, void* data, sd_bus_error*) {
    const sd_bus_error* error = sd_bus_message_get_error(message);
    if (error != nullptr) {
      static_cast<Implementation*>(data)->NotAdvertised("avahi-daemon: " +
                                                        std::string(error->message));
    }
    return 0;
  }

  static int OnState(sd_bus_message* message, void* data, sd_bus_error*) {
    auto* const self = static_cast<Implementation*>(data);
    int state = 0;
    const char* why = nullptr;
    if (self->group_ != sd_bus_message_get_path(message)) return 0;
    if (sd_bus_message_read(message, "is", &state, &why) < 0) return 0;
    const std::string& name = self->services_.front().name;
    if (state == kEstablished) log::Info("advertised in the network as \"" + name + "\"");
    if (state == kCollision) {
      self->NotAdvertised("another server is called \"" + name +
                          "\": set advertise to another name");
    }
    return 0;
  }

  /// Everything that is there, then waits for more.
  void Process() {
    int done = 1;
    while (done > 0) done = sd_bus_process(bus_, nullptr);
    if (done < 0) return NotAdvertised("the system bus has gone");
    const auto again = [self = shared_from_this()](const boost::system::error_code& error) {
      if (!error && !self->stopped_) self->Process();
    };
    const int wanted = sd_bus_get_events(bus_);
    readable_.cancel();
    writable_.cancel();
    readable_.async_wait(asio::posix::stream_descriptor::wait_read, again);
    if ((wanted & POLLOUT) != 0) {
      writable_.async_wait(asio::posix::stream_descriptor::wait_write, again);
    }
  }

  const std::vector<Service> services_;
  asio::posix::stream_descriptor readable_, writable_;
  sd_bus* bus_ = nullptr;
  std::string group_;
  bool stopped_ = false;
};

Advertiser::Advertiser(asio::io_context& io, std::vector<Service> services) {
  if (services.empty()) return;
  implementation_ = std::make_shared<Implementation>(io, std::move(services));
  implementation_->Start();
}

Advertiser::~Advertiser() {
  if (implementation_) implementation_->Stop();
}

std::vector<Service> ServicesOf(const transport::Server& server, std::size_t listeners,
                                const std::string& name, const std::string& program) {
  std::vector<Service> services;
  for (std::size_t i = 0; i < listeners && !name.empty(); ++i) {
    const transport::Address address = server.ListeningOn(i);
    if (!address.OverTcp() || transport::StaysOnThisHost(address)) continue;
    const bool tls = address.kind == transport::Address::Kind::kTls;
    services.push_back({name, program, address.port, tls, tls ? server.fingerprint() : ""});
  }
  // One name is one port: of several the encrypted one.
  for (const Service& service : services) {
    if (service.tls) return {service};
  }
  if (services.size() > 1) services.resize(1);
  return services;
}

namespace {

constexpr const char* kServer = "org.freedesktop.Avahi.Server";
constexpr const char* kBrowser = "org.freedesktop.Avahi.ServiceBrowser";
constexpr std::size_t kMostFound = 256, kMostNameBytes = 63;

using Bus = std::unique_ptr<sd_bus, decltype(&sd_bus_flush_close_unref)>;

/// Where a name was seen: on which interface, and of which protocol.
struct Item {
  int interface = 0, protocol = 0;
  std::string name, domain;
};

struct Seen {
  std::map<std::string, Item> by_name;
  bool all_for_now = false;
};

int OnSignal(sd_bus_message* message, void* data, sd_bus_error*) {
  auto& seen = *static_cast<Seen*>(data);
  if (sd_bus_message_is_signal(message, kBrowser, "AllForNow") > 0) seen.all_for_now = true;
  if (sd_bus_message_is_signal(message, kBrowser, "ItemNew") <= 0) return 0;
  Item item;
  const char *name = nullptr, *type = nullptr, *domain = nullptr;
  if (sd_bus_message_read(message, "iisss", &item.interface, &item.protocol, &name, &type,
                          &domain) < 0) {
    return 0;
  }
  item.name = name;
  item.domain = domain;
  // IPv4 before IPv6, whose addresses often need the name of an interface.
  const auto [known, fresh] = seen.by_name.try_emplace(item.name, item);
  if (!fresh && item.protocol == kIpv4) known->second = item;
  return 0;
}

std::vector<std::string> ReadTexts(sd_bus_message* message) {
  std::vector<std::string> texts;
  if (sd_bus_message_enter_container(message, 'a', "ay") < 0) return texts;
  const void* bytes = nullptr;
  std::size_t size = 0;
  while (sd_bus_message_read_array(message, 'y', &bytes, &size) > 0) {
    texts.emplace_back(static_cast<const char*>(bytes), size);
  }
  return texts;
}

/// Where it is and what it says; false when it does not answer.
bool Resolve(sd_bus* bus, const Item& item, Found& found) {
  sd_bus_message* answer = nullptr;
  sd_bus_error error{};
  const int called = sd_bus_call_method(
      bus, kAvahi, "/", kServer, "ResolveService", &error, &answer, "iisssiu", item.interface,
      item.protocol, item.name.c_str(), kServiceType, item.domain.c_str(), item.protocol, 0u);
  sd_bus_error_free(&error);
  if (called < 0) return false;
  const std::unique_ptr<sd_bus_message, decltype(&sd_bus_message_unref)> owned(
      answer, &sd_bus_message_unref);
  int interface = 0, protocol = 0, address_protocol = 0;
  const char *name = nullptr, *type = nullptr, *domain = nullptr, *host = nullptr,
             *address = nullptr;
  if (sd_bus_message_read(answer, "iissssisq", &interface, &protocol, &name, &type, &domain, &host,
                          &address_protocol, &address, &found.service.port) < 0) {
    return false;
  }
  found.service.name = Printable(item.name, kMostNameBytes);
  ReadTextRecord(ReadTexts(answer), found.service);
  found.address.kind =
      found.service.tls ? transport::Address::Kind::kTls : transport::Address::Kind::kTcp;
  found.address.host = address;
  found.address.port = found.service.port;
  return true;
}

}  // namespace

Result<std::vector<Found>> Browse(double within_s) {
  sd_bus* opened = nullptr;
  if (const int error = sd_bus_open_system(&opened); error < 0) {
    return Failure("no system bus: " + std::string(std::strerror(-error)) +
                   "; name the server's address with --connect");
  }
  const Bus bus(opened, &sd_bus_flush_close_unref);
  Seen seen;
  sd_bus_match_signal(bus.get(), nullptr, kAvahi, nullptr, kBrowser, nullptr, &OnSignal, &seen);
  sd_bus_error error{};
  const int begun =
      sd_bus_call_method(bus.get(), kAvahi, "/", kServer, "ServiceBrowserNew", &error, nullptr,
                         "iissu", kAnyInterface, kAnyProtocol, kServiceType, "", 0u);
  const std::string why = error.message == nullptr ? "" : error.message;
  sd_bus_error_free(&error);
  if (begun < 0) {
    return Failure("avahi-daemon does not answer: " + why +
                   "; install and start it, or name the server's address with --connect");
  }
  const auto end = timer::Now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                      std::chrono::duration<double>(within_s));
  while (!seen.all_for_now && timer::Now() < end && seen.by_name.size() < kMostFound) {
    if (sd_bus_process(bus.get(), nullptr) > 0) continue;
    const auto left = std::chrono::duration_cast<std::chrono::microseconds>(end - timer::Now());
    if (left.count() > 0) sd_bus_wait(bus.get(), static_cast<std::uint64_t>(left.count()));
  }
  std::vector<Found> all;
  for (const auto& [name, item] : seen.by_name) {
    Found found;
    if (Resolve(bus.get(), item, found)) all.push_back(std::move(found));
  }
  return all;
}

}  // namespace footing::discovery
