// An ESP32 with an MPU-6050 (or MPU-6500) as a sensor of Footing: 100 samples a second over Wi-Fi, five in a packet.
// Libraries: the ESP32 core's WiFi and Wire. Wiring: SDA 21, SCL 22, 3.3 V, GND. On the host:
//   footing-stream sensors --listen HOST:6969 --role right_hand
#include <WiFi.h>
#include <WiFiUdp.h>
#include <Wire.h>

const char* kNetwork = "your network";
const char* kPassword = "your password";
const IPAddress kHost(192, 168, 1, 5);  // The host of footing-stream.
const uint16_t kPort = 6969;

const uint8_t kMpu = 0x68;
const int kSamples = 5;
const float kMps2 = 9.80665f / 4096;               // At a range of 8 g.
const float kRadps = 3.14159265f / 180 / 16.384f;  // At a range of 2000 degrees/s.

const uint8_t kFlags = 2 | 8, kEndOfX = 16;         // With rates; it says where the range ends.

// The report of any inertial sensor (docs/devices.md), as it lies in the memory of a little-endian processor.
struct __attribute__((packed)) Sample {
  uint32_t age_us;
  float acceleration[3], rate[3];
};
struct __attribute__((packed)) Report {
  uint8_t id = 1, flags = kFlags, buttons = 0, battery = 255;
  uint16_t number = 0;
  uint64_t time_us = 0;
  uint8_t count = kSamples;
  Sample samples[kSamples];
} report;
static_assert(sizeof(Report) == 15 + 28 * kSamples, "no padding");

WiFiUDP udp;
int filled = 0;
int64_t due_us = 0, taken_us[kSamples];

void Write(uint8_t reg, uint8_t value) {
  Wire.beginTransmission(kMpu);
  Wire.write(reg);
  Wire.write(value);
  Wire.endTransmission();
}

int16_t Next() {
  const int high = Wire.read();
  return (int16_t)(high << 8 | Wire.read());
}

void setup() {
  Wire.begin();
  Wire.setClock(400000);
  Write(0x6B, 1);     // Awake.
  Write(0x1A, 3);     // Low-pass at 44 Hz.
  Write(0x1B, 0x18);  // 2000 degrees/s.
  Write(0x1C, 0x10);  // 8 g.
  WiFi.begin(kNetwork, kPassword);
  WiFi.setSleep(false);  // Asleep between beacons it would send in bunches.
  udp.begin(kPort);
}

void loop() {
  const int64_t now_us = esp_timer_get_time();
  if (now_us < due_us) return;
  due_us = now_us + 10000;
  Wire.beginTransmission(kMpu);
  Wire.write(0x3B);
  Wire.endTransmission(false);
  Wire.requestFrom(kMpu, (uint8_t)14);
  Sample& sample = report.samples[filled];
  for (int axis = 0; axis < 3; ++axis) {
    const int16_t count = Next();
    if (count == INT16_MAX || count == INT16_MIN) report.flags |= kEndOfX << axis;
    sample.acceleration[axis] = count * kMps2;
  }
  Next();  // Temperature.
  for (int axis = 0; axis < 3; ++axis) sample.rate[axis] = Next() * kRadps;
  taken_us[filled++] = now_us;
  if (filled < kSamples) return;
  filled = 0;
  report.number++;
  report.time_us = now_us;
  for (int i = 0; i < kSamples; ++i) report.samples[i].age_us = now_us - taken_us[i];
  if (WiFi.status() == WL_CONNECTED) {
    udp.beginPacket(kHost, kPort);
    udp.write((const uint8_t*)&report, sizeof(report));
    udp.endPacket();
  }
  report.flags = kFlags;
}
