#include "common/runtime/config.h"

#include <string>

#include "common/net/access.h"
#include "common/net/address.h"
#include "tests/fuzz/input.h"

/// Any text as a config file, as settings, as an address and as a list of clients: taken or refused
/// with one line; what was taken is within its range, and printed it is taken again.
namespace footing::fuzz {
namespace {

struct Settings {
  Settings() {
    binder.Number("number", number, -1, 2, "A number");
    binder.Integer("integer", integer, 0, 10, "An integer");
    binder.Flag("flag", flag, "A flag");
    binder.Text("text", text, "A text");
    binder.TextList("list", list, "A list");
    binder.TextMap("map", map, "A map",
                   [](const std::string& value) { return value.size() > 4 ? "long" : ""; });
  }
  Settings(const Settings&) = delete;

  void Check() const {
    Expect(number >= -1 && number <= 2 && integer >= 0 && integer <= 10);
    for (const auto& [key, value] : map) Expect(value.size() <= 4);
  }

  double number = 0;
  std::int64_t integer = 0;
  bool flag = false;
  std::string text;
  std::vector<std::string> list;
  std::map<std::string, std::string> map;
  config::Binder binder;
};

void CheckConfig(const std::string& text, Input input) {
  Settings settings;
  const auto applied = settings.binder.ApplyText(text, "f");
  while (!input.empty()) {
    const Bytes bytes = input.String();
    (void)settings.binder.ApplySetting({bytes.begin(), bytes.end()}).ok();
  }
  settings.Check();
  Settings whole;  // As a program is started: no file, and the same text as one setting.
  Expect(!whole.binder.Apply("", {text}) || text.find('=') != std::string::npos);
  (void)settings.binder.ApplySetting("text=" + text, "--text").ok();
  const std::string printed = settings.binder.Print();
  Settings again;
  Expect(again.binder.ApplyText(printed, "p").ok() && again.binder.Print() == printed);
  Expect(config::Differences(settings.binder, again.binder).empty());
  Settings fresh;
  (void)config::Differences(fresh.binder, settings.binder);
  Expect(!settings.binder.PrintOrigins().empty() && !settings.binder.Describe().empty());
  for (const auto& [key, line] : config::LinesOfKeys(text)) Expect(line > 0);
}

void CheckAddress(const std::string& text) {
  const auto address = transport::ParseAddress(text);
  if (!address) return;
  const auto again = transport::ParseAddress(address->Text());
  Expect(again.ok() && again->Text() == address->Text());
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  const std::uint8_t how = input.Byte();
  const fuzz::Bytes settings = how % 3 == 0 ? input.String() : fuzz::Bytes();
  const fuzz::Bytes rest = input.Rest();
  const std::string text(rest.begin(), rest.end());
  switch (how % 3) {
    case 0:
      fuzz::CheckConfig(text, fuzz::Input(settings.data(), settings.size()));
      break;
    case 1:
      fuzz::CheckAddress(text);
      break;
    default:
      (void)transport::ParseClients(text).ok();
  }
  return 0;
}
