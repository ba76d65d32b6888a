#include "tests/device_faults/testbed.h"

#include <sys/stat.h>
#include <umockdev.h>

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "tests/device_faults/report_descriptor.h"

namespace footing::device_faults {
namespace {

std::string Format(const char* format, unsigned a, unsigned b, unsigned c, int d = 0) {
  char text[64];
  std::snprintf(text, sizeof(text), format, a, b, c, d);
  return text;
}

/// Under /sys; the number stands for the kernel's own count of HID devices.
std::string HidPath(int number, const virtual_devices::Identity& identity) {
  return "/devices/virtual/misc/uhid/" +
         Format("%04X:%04X:%04X.%04X", identity.bus, identity.vendor, identity.product, number);
}

std::string NodePath(int number, const virtual_devices::Identity& identity) {
  return HidPath(number, identity) + "/hidraw/hidraw" + std::to_string(number);
}

}  // namespace

Testbed::Testbed() : testbed_(umockdev_testbed_new()) {}

Testbed::~Testbed() { g_object_unref(testbed_); }

void Testbed::Add(int number, const virtual_devices::Identity& identity, const std::string& driver,
                  bool with_identity) {
  std::string descriptor;
  for (const std::uint8_t byte : kReportDescriptor) descriptor += Format("%02X", byte, 0, 0);
  const std::string node = "hidraw" + std::to_string(number);
  std::string text =
      "P: " + HidPath(number, identity) + "\nE: SUBSYSTEM=hid\nE: DRIVER=" + driver +
      "\nE: HID_ID=" + Format("%04X:%08X:%08X", identity.bus, identity.vendor, identity.product) +
      "\nE: HID_PHYS=00:1a:7d:da:71:13\n";
  if (with_identity) {
    text += "E: HID_NAME=" + identity.name + "\nE: HID_UNIQ=" + identity.serial + "\n";
  }
  text += "H: report_descriptor=" + descriptor + "\nL: driver=../../../../../bus/hid/drivers/" +
          driver + "\n\nP: " + NodePath(number, identity) + "\nN: " + node + "\nE: DEVNAME=/dev/" +
          node + "\nE: MAJOR=240\nE: MINOR=" + std::to_string(number) +
          "\nE: SUBSYSTEM=hidraw\nA: dev=240:" + std::to_string(number) +
          "\\n\nL: device=../../../" + HidPath(number, identity).substr(26) + "\n\n";
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) {
    throw std::runtime_error(std::string("bench: ") + error->message);
  }
}

void Testbed::Identify(int number, const virtual_devices::Identity& identity) {
  const std::string path = "/sys" + HidPath(number, identity);
  umockdev_testbed_set_property(testbed_, path.c_str(), "HID_NAME", identity.name.c_str());
  umockdev_testbed_set_property(testbed_, path.c_str(), "HID_UNIQ", identity.serial.c_str());
}

void Testbed::HalfRemove(int number, const virtual_devices::Identity& identity) {
  char* const folder = umockdev_testbed_get_root_dir(testbed_);
  const std::string root = folder;
  g_free(folder);
  if (chmod((root + "/sys" + HidPath(number, identity) + "/uevent").c_str(), 0) != 0) {
    throw std::runtime_error("bench: the device has no uevent file");
  }
}

void Testbed::Remove(int number, const virtual_devices::Identity& identity) {
  Announce(number, identity, "remove");
  umockdev_testbed_remove_device(testbed_, ("/sys" + HidPath(number, identity)).c_str());
}

void Testbed::Announce(int number, const virtual_devices::Identity& identity,
                       const std::string& action) {
  umockdev_testbed_uevent(testbed_, ("/sys" + NodePath(number, identity)).c_str(), action.c_str());
}

}  // namespace footing::device_faults
