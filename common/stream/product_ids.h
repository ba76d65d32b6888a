#pragma once

#include <cstdint>

/// How devices present themselves to their host, as the kernel shows it.
namespace footing::stream {

/// As the kernel's input.h numbers them.
enum class Bus : std::uint32_t { kUnknown = 0, kUsb = 3, kBluetooth = 5 };

inline constexpr std::uint32_t kVendorNintendo = 0x057e;
inline constexpr std::uint32_t kProductFirst = 0x0306;  ///< Wiimote, and every Balance Board.
inline constexpr std::uint32_t kProductTr = 0x0330;     ///< Wiimote with MotionPlus inside.

// Controllers of the Switch.
inline constexpr std::uint32_t kProductJoyConLeft = 0x2006;
inline constexpr std::uint32_t kProductJoyConRight = 0x2007;
inline constexpr std::uint32_t kProductSwitchPro = 0x2009;

inline constexpr std::uint32_t kVendorSony = 0x054c;
inline constexpr std::uint32_t kProductZcm1 = 0x03d5;  ///< PS Move, over USB and over Bluetooth.
inline constexpr std::uint32_t kProductZcm2 = 0x0c5e;

inline bool IsOfSwitch(std::uint32_t vendor, std::uint32_t product) {
  return vendor == kVendorNintendo &&
         (product == kProductJoyConLeft || product == kProductJoyConRight ||
          product == kProductSwitchPro);
}

/// An inertial sensor that is not a HID device: its reports are Footing's own.
inline constexpr std::uint32_t kVendorFooting = 0xf007;
inline constexpr std::uint32_t kProductInertial = 0x0001;

inline bool IsInertialSensor(std::uint32_t vendor, std::uint32_t product) {
  return vendor == kVendorFooting && product == kProductInertial;
}

/// A HID device that Footing knows.
inline bool IsKnownDevice(std::uint32_t vendor, std::uint32_t product) {
  return (vendor == kVendorNintendo && (product == kProductFirst || product == kProductTr)) ||
         IsOfSwitch(vendor, product) ||
         (vendor == kVendorSony && (product == kProductZcm1 || product == kProductZcm2));
}

}  // namespace footing::stream
