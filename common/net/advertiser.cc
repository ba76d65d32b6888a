#include "common/net/advertiser.h"

#include <poll.h>
#include <systemd/sd-bus.h>
#include <unistd.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstring>
#include <utility>

#include "common/runtime/log.h"
#include "common/net/socket.h"

namespace footing::discovery {
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

}  // namespace footing::discovery
