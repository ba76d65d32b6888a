#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "footing/v1/session.pb.h"

namespace footing::device_faults {

/// Messages of footingd so far, and their flaws whatever the fault: a number that is not finite, a
/// sample before the one before it, a sample taken after it was received.
class Seen {
 public:
  void Take(const v1::Tick& tick);

  /// The newest status of a serial; null when there is none.
  const v1::DeviceStatus* Status(const std::string& serial) const;
  const std::vector<v1::MotionSample>& Motion(const std::string& serial) const;
  const std::vector<v1::BoardSample>& Boards(const std::string& serial) const;
  const std::vector<v1::NunchukSample>& Nunchuk(const std::string& serial) const;
  const std::vector<v1::CameraSample>& Camera(const std::string& serial) const;
  const std::vector<v1::RawReport>& Raw(const std::string& serial) const;
  const std::vector<v1::Tick>& feature_ticks() const { return feature_ticks_; }
  std::size_t devices() const { return numbers_.size(); }
  std::uint64_t ticks() const { return ticks_; }
  /// Every distinct note a device has had.
  const std::vector<std::string>& Notes(const std::string& serial) const;
  const std::vector<std::string>& wrongs() const { return wrongs_; }
  void Forget();  ///< All samples; devices stay known.

 private:
  template <typename Sample>
  void Keep(const Sample& sample, std::map<std::uint32_t, std::vector<Sample>>& all,
            const char* what);
  void CheckNumbers(const google::protobuf::Message& message);
  std::uint32_t Number(const std::string& serial) const;

  std::map<std::string, std::uint32_t> numbers_;
  std::map<std::uint32_t, v1::DeviceStatus> status_;
  std::map<std::uint32_t, std::vector<std::string>> notes_;
  std::map<std::uint32_t, std::vector<v1::MotionSample>> motion_;
  std::map<std::uint32_t, std::vector<v1::BoardSample>> boards_;
  std::map<std::uint32_t, std::vector<v1::NunchukSample>> nunchuk_;
  std::map<std::uint32_t, std::vector<v1::CameraSample>> camera_;
  std::map<std::uint32_t, std::vector<v1::RawReport>> raw_;
  std::vector<v1::Tick> feature_ticks_;
  std::vector<std::string> wrongs_;
  std::uint64_t ticks_ = 0;
};

}  // namespace footing::device_faults
