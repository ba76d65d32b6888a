#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/device.h"
#include "common/net/address.h"
#include "common/net/client.h"

namespace footing::camera {

/// The lights of the PS Moves that footingd has, switched through its client socket as footing-ctl
/// led does. Everything runs on the io_context's thread.
class Lights {
 public:
  /// `on_devices` is called for every list of devices, about once a second and at every change.
  Lights(boost::asio::io_context& io, const transport::Address& address,
         std::function<void()> on_devices);

  void Start() { client_.Start(); }
  void Stop() { client_.Stop(); }

  /// PS Moves that are there and have a role, in the order of their roles.
  const std::vector<stream::DeviceStatus>& moves() const { return moves_; }
  /// Whether a list of devices has come; else `link()` says why not.
  bool has_list() const { return has_list_; }
  const std::string& link() const { return link_; }

  /// Sets one light, 0xRRGGBB; `done` gets footingd's refusal.
  void Set(std::uint32_t device, std::uint32_t rgb, std::function<void(Result<void>)> done);

 private:
  void OnTick(const v1::Tick& tick);

  std::function<void()> on_devices_;
  std::vector<stream::DeviceStatus> moves_;
  bool has_list_ = false;
  std::string link_ = "not connected";
  transport::Client client_;
};

}  // namespace footing::camera
