#include "common/net/browser.h"

#include <systemd/sd-bus.h>

#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <utility>

#include "common/runtime/timer.h"

namespace footing::discovery {
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
