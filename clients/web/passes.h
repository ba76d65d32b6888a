#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace footing::web {

/// Right of a browser: to watch, to answer a study's survey, to attach devices. Each includes those
/// before it.
enum class Right { kNone, kView, kAnswer, kDevices };

/// One-time codes, which a QR code shows, and the passes that browsers get for them, which they
/// keep in a cookie. A plain value; instants are of CLOCK_MONOTONIC. Of passes it knows no more
/// than their SHA-256, so that who reads what is kept of them for the next start gets none.
class Passes {
 public:
  static constexpr double kCodeLastsS = 600;
  static constexpr double kPassLastsS = 12 * 3600;
  static constexpr std::size_t kMostCodes = 16;    ///< The oldest one goes.
  static constexpr std::size_t kMostPasses = 256;  ///< Likewise.

  /// `random` makes a secret of at least 96 bits, in letters and digits.
  explicit Passes(std::function<std::string()> random) : random_(std::move(random)) {}

  /// A code for one browser, within kCodeLastsS.
  std::string NewCode(Right right, std::int64_t now_ns);
  /// A pass for a code, which is thereby used; nothing for one that is wrong, used or old.
  std::optional<std::string> Redeem(std::string_view code, std::int64_t now_ns);
  /// The right of a pass; kNone where there is none such.
  Right RightOf(std::string_view pass, std::int64_t now_ns) const;

  /// The passes for the next start, a line each: SHA-256, right, and the second of the wall clock
  /// until which it lasts.
  std::string Text(std::int64_t now_ns, std::int64_t wall_ns) const;
  /// Takes such lines in; others are ignored, and so are those that are over.
  void Take(std::string_view text, std::int64_t now_ns, std::int64_t wall_ns);

 private:
  struct Entry {
    std::string secret;  ///< A code, or the SHA-256 of a pass.
    Right right = Right::kNone;
    std::int64_t until_ns = 0;
  };

  std::function<std::string()> random_;
  std::deque<Entry> codes_, passes_;
};

/// The value of a cookie in a request's Cookie header; empty when it is not there.
std::string_view CookieIn(std::string_view header, std::string_view name);

/// Whether a browser's Host header, "NAME" or "NAME:PORT", names this host: a numeric address,
/// localhost, or one of `names`. A browser that was led here by a foreign name (DNS rebinding)
/// sends that name; a numeric address cannot be rebound.
bool IsOwnHost(std::string_view host, const std::vector<std::string>& names);

}  // namespace footing::web
