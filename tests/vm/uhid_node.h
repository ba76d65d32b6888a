#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/virtual/devices/controller.h"

namespace footing::vm {

/// A HID device that the kernel believes in, made through /dev/uhid.
class UhidNode {
 public:
  struct Handlers {
    std::function<void()> on_start;  ///< The kernel's driver took the device: its node comes.
    std::function<void(std::span<const std::uint8_t>)> on_output;
    /// A feature report by its id; none refuses the request.
    std::function<std::optional<virtual_devices::Report>(std::uint8_t)> on_feature;
  };

  /// Aborts when /dev/uhid cannot be opened: nothing can be tested then.
  explicit UhidNode(Handlers handlers);
  ~UhidNode();
  UhidNode(const UhidNode&) = delete;
  UhidNode& operator=(const UhidNode&) = delete;

  void Plug(const virtual_devices::Identity& identity, std::span<const std::uint8_t> descriptor);
  void Unplug();
  void Send(std::span<const std::uint8_t> report);

  /// To be polled for reading.
  int descriptor() const { return file_; }
  /// Handles one event that is there.
  void HandleEvent();

 private:
  void Write(const void* event, std::size_t bytes);

  Handlers handlers_;
  int file_ = -1;
};

}  // namespace footing::vm
