#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/virtual/devices/wiimote.h"

namespace footing::handshake {

/// A Wiimote with things in its extension port that come and go, as WiiBrew's pages "Extension
/// Controllers" and "Wii Motion Plus" describe them; the blocks are those of real units.
class PortModel {
 public:
  using Report = virtual_devices::Report;
  enum class Child { kNone, kNunchuk, kClassic, kUnknown };

  explicit PortModel(Child child = Child::kNone, bool motion_plus = false, std::uint64_t seed = 5)
      : wiimote_(seed), child_(child), motion_plus_(motion_plus) {}

  const virtual_devices::Identity& identity() const { return wiimote_.identity(); }

  static constexpr std::array<std::uint8_t, 16> kNunchukBlock = {0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf,
                                                                 0xb1, 0x12, 0xe5, 0x21, 0x7c, 0xe7,
                                                                 0x23, 0x7a, 0xfc, 0x51};
  static constexpr std::array<std::uint8_t, 32> kMotionPlusBlock = {
      0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e,
      0xa8, 0xc8, 0x77, 0x5e, 0x02, 0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b,
      0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    const bool registers = report.size() >= 7 && (report[1] & 0x04) != 0;
    const std::uint32_t address =
        registers ? std::uint32_t{report[2]} << 16 | std::uint32_t{report[3]} << 8 | report[4] : 0;
    const std::uint32_t page = address >> 8;
    std::vector<Report> answers;
    if (report[0] == 0x16 && (page == 0xa400 || page == 0xa600)) {
      answers.push_back({0x22, 0, 0, 0x16, Write(address, report[6], answers)});
      std::rotate(answers.begin(), answers.end() - 1, answers.end());
    } else if (report[0] == 0x17 && (page == 0xa400 || page == 0xa600)) {
      Read(address, static_cast<std::size_t>(report[5] << 8 | report[6]), answers);
    } else {
      answers = wiimote_.HandleOutput(report);
      for (Report& answer : answers) {
        if (answer[0] == 0x20) SetExtensionBit(answer);
      }
    }
    return answers;
  }

  std::optional<Report> Sample(const Eigen::Vector3d& specific_force_S_mps2 = {0, 0, -9.81}) {
    auto report = wiimote_.Sample(specific_force_S_mps2);
    if (!report) return report;
    const std::size_t at = (*report)[0] == 0x35 ? 6 : (*report)[0] == 0x37 ? 16 : 0;
    if (at == 0) return report;
    const auto bytes = ExtensionBytes();
    std::copy(bytes.begin(), bytes.end(), report->begin() + static_cast<std::ptrdiff_t>(at));
    return report;
  }

  /// Reports of the Wiimote at a change of plugs. Under an active MotionPlus a child says nothing.
  std::vector<Report> SetChild(Child child) {
    child_ = child;
    plain_ = key_ = false;
    if (active_) return {};
    return {Unasked()};
  }
  std::vector<Report> SetMotionPlus(bool plugged) {
    const bool said = active_ || child_ != Child::kNone;
    motion_plus_ = plugged;
    active_ = false;
    plain_ = key_ = false;
    if (!said) return {};
    return {Unasked()};
  }
  /// The identity is FF for so many reads.
  int not_ready = 0;
  bool activates = true;

  Report Unasked() {
    Report status = wiimote_.controller().UnaskedStatus();
    SetExtensionBit(status);
    return status;
  }
  bool active() const { return active_; }
  std::uint8_t active_mode() const { return active_mode_; }
  int activations() const { return activations_; }
  virtual_devices::Controller& controller() { return wiimote_.controller(); }
  std::uint8_t camera_register(std::uint32_t at) {
    std::array<std::uint8_t, 1> byte{};
    (void)controller().memory().Read(true, 0xb00000 + at, byte);
    return byte[0];
  }

 private:
  bool Plugged() const { return active_ || child_ != Child::kNone; }
  void SetExtensionBit(Report& status) const {
    status[3] = static_cast<std::uint8_t>((status[3] & ~2) | (Plugged() ? 2 : 0));
  }

  std::uint8_t Write(std::uint32_t address, std::uint8_t value, std::vector<Report>& unasked) {
    if (address >> 8 == 0xa600) {
      if (!motion_plus_ || active_) return 7;
      if (address == 0xa600fe && activates) {
        active_ = true;
        active_mode_ = value;
        rubbish_ = 2;
        ++activations_;
        DetectPinMoves(unasked);
      }
      return 0;
    }
    if (!Plugged()) return 7;
    if (address == 0xa400f0 && active_) {
      active_ = false;
      key_ = true;  // Goes on to the child.
      plain_ = false;
      DetectPinMoves(unasked);
    } else if (address == 0xa400f0) {
      key_ = value == 0x55;
      plain_ = false;
    } else if (address == 0xa400fb) {
      plain_ = key_ && value == 0;
    }
    return 0;
  }

  /// About 20 ms low, told at once here: both reports come within the dead window anyway.
  void DetectPinMoves(std::vector<Report>& unasked) {
    Report low = Unasked();
    low[3] = static_cast<std::uint8_t>(low[3] & ~2);
    unasked.push_back(low);
    if (Plugged()) unasked.push_back(Unasked());
  }

  std::array<std::uint8_t, 6> Identity(bool motion_plus_page) {
    if (motion_plus_page) return {0x01, 0x00, 0xa6, 0x20, 0x00, 0x05};
    if (not_ready > 0) {
      --not_ready;
      return {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    }
    if (active_) return {0x00, 0x00, 0xa4, 0x20, active_mode_, 0x05};
    if (!plain_) return {0x5d, 0x3c, 0x11, 0x90, 0xe1, 0x07};  // Encrypted.
    if (child_ == Child::kNunchuk) return {0xff, 0x00, 0xa4, 0x20, 0x00, 0x00};
    if (child_ == Child::kClassic) return {0x01, 0x00, 0xa4, 0x20, 0x01, 0x01};
    return {0x00, 0x00, 0xa4, 0x20, 0x77, 0x77};
  }

  void Read(std::uint32_t address, std::size_t size, std::vector<Report>& answers) {
    const bool motion_plus_page = address >> 8 == 0xa600;
    const bool there = motion_plus_page ? motion_plus_ && !active_ : Plugged();
    std::array<std::uint8_t, 256> page{};
    const auto identity = there ? Identity(motion_plus_page) : std::array<std::uint8_t, 6>{};
    std::copy(identity.begin(), identity.end(), page.begin() + 0xfa);
    if (motion_plus_page || active_) {
      std::copy(kMotionPlusBlock.begin(), kMotionPlusBlock.end(), page.begin() + 0x20);
    } else if (child_ == Child::kNunchuk) {
      std::copy(kNunchukBlock.begin(), kNunchukBlock.end(), page.begin() + 0x20);
      std::copy(kNunchukBlock.begin(), kNunchukBlock.end(), page.begin() + 0x30);
    }
    for (std::size_t at = 0; at < size; at += 16) {
      Report piece(22, 0);
      const std::size_t count = std::min<std::size_t>(16, size - at);
      const auto offset = static_cast<std::uint16_t>(address + at);
      piece[0] = 0x21;
      piece[3] = there ? static_cast<std::uint8_t>((count - 1) << 4) : std::uint8_t{0xf7};
      piece[4] = static_cast<std::uint8_t>(offset >> 8);
      piece[5] = static_cast<std::uint8_t>(offset);
      for (std::size_t i = 0; there && i < count; ++i) piece[6 + i] = page[(offset & 0xff) + i];
      answers.push_back(piece);
      if (!there) return;
    }
  }

  std::array<std::uint8_t, 6> ExtensionBytes() {
    constexpr std::array<std::uint8_t, 6> kNothing = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    const auto connected = static_cast<std::uint8_t>(child_ != Child::kNone ? 1 : 0);
    if (active_) {
      if (rubbish_ > 0) {
        --rubbish_;
        return kNothing;
      }
      turn_ = !turn_;
      if (turn_ && child_ == Child::kNunchuk && active_mode_ == 0x05) {
        return {0x80, 0x80, 0x80, 0x80, static_cast<std::uint8_t>(0xb0 | connected), 0x0c};
      }
      // Still: 0x1f7f in yaw, roll and pitch, all slow.
      return {0x7f, 0x7f, 0x7f, 0x7f, static_cast<std::uint8_t>(0x7e | connected), 0x7e};
    }
    if (child_ == Child::kNunchuk && plain_) return {0x80, 0x80, 0x80, 0x80, 0xb3, 0x03};
    return kNothing;
  }

  virtual_devices::Wiimote wiimote_;
  Child child_;
  bool motion_plus_;
  bool active_ = false;
  std::uint8_t active_mode_ = 0;
  int activations_ = 0;
  int rubbish_ = 0;
  bool turn_ = false;
  bool key_ = false;
  bool plain_ = false;
};

}  // namespace footing::handshake
