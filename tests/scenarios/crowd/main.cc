#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "tests/scenarios/crowd/crowd.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

constexpr std::int64_t kSecondNs = 1'000'000'000;

struct Flags {
  std::vector<std::string> addresses;
  std::size_t viewers = 100;
  double seconds = 5;
};

/// Prints "begin" and "end" around the time in which it counts, then what it got.
Result<nlohmann::ordered_json> Run(const Flags& flags) {
  std::vector<transport::Address> addresses;
  for (const std::string& text : flags.addresses) {
    const auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    addresses.push_back(*address);
  }
  crowd::Crowd crowd(addresses);
  if (auto connected = crowd.Connect(flags.viewers); !connected) return connected.error();
  std::int64_t now_ns = clock::MonotonicNs();
  if (auto read = crowd.Read(now_ns + kSecondNs, 0, 0); !read) return read.error();
  now_ns = clock::MonotonicNs();
  const std::int64_t to_ns = now_ns + static_cast<std::int64_t>(flags.seconds * 1e9);
  std::cout << "begin" << std::endl;
  if (auto read = crowd.Read(to_ns, now_ns, to_ns); !read) return read.error();
  std::cout << "end" << std::endl;
  // A late tick is not lost.
  if (auto read = crowd.Read(to_ns + 5 * kSecondNs, now_ns, to_ns); !read) return read.error();
  const crowd::Tally tally = crowd.tally();
  if (tally.delivered == 0) return Failure("no tick came");
  return nlohmann::ordered_json{{"viewers", flags.viewers},
                                {"seconds", flags.seconds},
                                {"rate_hz", tally.rate_hz},
                                {"expected", tally.expected},
                                {"delivered", tally.delivered},
                                {"gaps", tally.gaps},
                                {"bytes", tally.bytes},
                                {"lag_p50_ms", text::Quantile(tally.lags_ms, 0.5)},
                                {"lag_p99_ms", text::Quantile(tally.lags_ms, 0.99)},
                                {"lag_max_ms", text::Quantile(tally.lags_ms, 1)}};
}

}  // namespace

int main(int argc, char** argv) {
  auto app =
      cli::NewApp("scenario_crowd", "Viewers by the thousand, and what they get.",
                  "  scenario_crowd --connect tcp:127.0.0.1:7460 --viewers 1000 --seconds 5");
  Flags flags;
  app->add_option("--connect", flags.addresses, "Address; may be repeated")->required();
  app->add_option("--viewers", flags.viewers, "Sessions")->check(CLI::Range(1, 50'000));
  app->add_option("--seconds", flags.seconds, "Duration, s")->check(CLI::Range(0.1, 600.0));
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  const auto result = Run(flags);
  if (!result) return cli::Report(result.error());
  std::cout << result->dump() << std::endl;
  return 0;
}
