#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "daemon/sensor/devices/source.h"

namespace footing::devices {

/// Real devices through hidapi's hidraw backend, as HidSearch finds them. A device that is gone and
/// comes back attaches again under its serial, also before the old node has ended. A device that
/// may not be opened is said once, with the udev rule that helps.
class HidSource : public DeviceSource {
 public:
  HidSource(boost::asio::io_context& io, std::function<DeviceHandle()> new_handle,
            SourceHandlers handlers);
  ~HidSource() override;

  Result<void> Start() override;
  void Send(DeviceHandle device, const reports::OutputReport& report) override;
  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) override;
  void Refuse(DeviceHandle, const std::string&) override {}
  std::string Stuck() const override;
  void Stop() override;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::devices
