#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace footing::tls {

/// The first bytes that a server reads: the header of a TLS record and that of the ClientHello in
/// it. They say whether the other side speaks TLS at all, and how long its first message is, before
/// anything is allocated for it.
class FirstBytes {
 public:
  static constexpr std::size_t kSize = 9;
  /// A ClientHello has some hundred bytes, and fits in one record.
  static constexpr std::size_t kLongestClientHello = 16u << 10;

  enum class Verdict {
    kMore,     ///< Not all are there yet.
    kTls,      ///< A ClientHello of a length that is accepted.
    kNotTls,   ///< Something else: the other side sends in clear.
    kTooLong,  ///< It announces a ClientHello over the limit, or in pieces that hide its length.
  };

  /// Where the next ones go; as many as are missing.
  char* next() { return bytes_.data() + size_; }
  std::size_t missing() const { return kSize - size_; }
  void Add(std::size_t bytes) { size_ += bytes; }
  std::string_view bytes() const { return {bytes_.data(), size_}; }

  Verdict Check() const;

 private:
  std::array<char, kSize> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace footing::tls
