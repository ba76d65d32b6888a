#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace footing {

/// Exit codes of every program, and the kinds of error they come from.
enum class ErrorKind {
  kFailure = 1,      ///< Something outside did not work (a socket, a file, a device).
  kUsage = 2,        ///< The command line or the config is wrong.
  kNoDevice = 3,     ///< No such device, or none at all.
  kInvalidData = 4,  ///< Bytes, a file or a recording that make no sense.
};

/// Failure of the outside world: one line that says what, which, where and what to do now.
struct Error {
  ErrorKind kind = ErrorKind::kFailure;
  std::string message;
};

/// A value or an Error. Our own bugs are CHECKs, not Results.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT: a value is a Result
  Result(Error error) : content_(std::move(error)) {}  // NOLINT: so is an error

  bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return std::get<0>(content_); }
  const T& value() const& { return std::get<0>(content_); }
  T&& value() && { return std::get<0>(std::move(content_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

/// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: an error is a Result

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

/// Shorthands: `return Failure("cannot open " + path + ": ...");`.
inline Error Failure(std::string message) { return {ErrorKind::kFailure, std::move(message)}; }
inline Error UsageError(std::string message) { return {ErrorKind::kUsage, std::move(message)}; }
inline Error NoDevice(std::string message) { return {ErrorKind::kNoDevice, std::move(message)}; }
inline Error InvalidData(std::string message) {
  return {ErrorKind::kInvalidData, std::move(message)};
}

/// Our bug: prints the condition and its place, and aborts. Always on.
[[noreturn]] void CheckFailed(const char* condition, const char* file, int line);

}  // namespace footing

#define FOOTING_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::footing::CheckFailed(#condition, __FILE__, __LINE__))
