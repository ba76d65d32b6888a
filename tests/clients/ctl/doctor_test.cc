#include "clients/ctl/report/doctor.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "common/virtual/devices/link_model.h"
#include "daemon/sensor/reports/device_clock.h"
#include "tests/clients/ctl/doctor_faults.h"

namespace footing::ctl::doctor {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Finding* Find(const std::vector<Finding>& findings, const std::string& id) {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const Finding& one) { return one.id == id; });
  return found == findings.end() ? nullptr : &*found;
}

TEST(Doctor, FindsNothingOnAHealthyHost) {
  const auto findings = Examine(HealthyHost());
  EXPECT_EQ(ToText(findings), "all is well");
  EXPECT_TRUE(Healthy(findings));
}

class DoctorNames : public ::testing::TestWithParam<Case> {};

TEST_P(DoctorNames, TheFaultAndItsRemedy) {
  const Case& one = GetParam();
  Facts facts = HealthyHost();
  one.fault(facts);
  const auto findings = Examine(facts);
  const Finding* finding = Find(findings, one.id);
  ASSERT_NE(finding, nullptr) << ToText(findings);
  EXPECT_EQ(finding->severity, one.severity);
  EXPECT_THAT(finding->remedy, HasSubstr(one.remedy));
  EXPECT_NE(finding->what, "");
  EXPECT_NE(finding->where, "");
}

INSTANTIATE_TEST_SUITE_P(Each, DoctorNames, ::testing::ValuesIn(Cases()),
                         [](const auto& one) { return std::string(one.param.id); });

TEST(Doctor, HasATestOfEveryCheck) {
  std::set<std::string> tested;
  for (const Case& one : Cases()) tested.insert(one.id);
  for (const std::string& id : CheckIds()) EXPECT_EQ(tested.count(id), 1u) << id;
  EXPECT_EQ(tested.size(), CheckIds().size());
}

/// How often, of the looks taken every half second, the doctor calls a simulated link poor.
/// `stall_s`: one pause of the host in the tenth second.
double ShareCalledPoor(const virtual_devices::LinkConfig& config, double stall_s) {
  virtual_devices::LinkModel link(config, 0);
  link::LinkStatistics statistics(1 / config.nominal_rate_hz);
  Facts facts = HealthyHost();
  stream::DeviceStatus& device = facts.devices[0];
  int looks = 0, poor = 0;
  std::int64_t next_look_ns = 4'000'000'000;
  while (next_look_ns < 120'000'000'000) {
    const std::int64_t arrives_ns = link.Next().arrives_ns;
    const bool stalled =
        arrives_ns > 10'000'000'000 && static_cast<double>(arrives_ns) < 1e10 + 1e9 * stall_s;
    if (stalled) continue;
    statistics.Advance(arrives_ns);
    if (arrives_ns < next_look_ns) continue;
    next_look_ns = arrives_ns + 500'000'000;
    device.reports = statistics.reports();
    device.gaps = statistics.gaps();
    device.report_rate_hz = statistics.RateHz(arrives_ns);
    device.jitter_ms = statistics.JitterMs();
    ++looks;
    poor += Find(Examine(facts), "poor_link") != nullptr ? 1 : 0;
  }
  return static_cast<double>(poor) / looks;
}

TEST(Doctor, CallsASimulatedGoodLinkGoodAndAPoorOnePoor) {
  using virtual_devices::LinkQuality;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const double stall_s : {0.0, 0.4}) {
      EXPECT_EQ(ShareCalledPoor(WiimoteLink(LinkQuality::kIdeal, seed), stall_s), 0) << seed;
      EXPECT_EQ(ShareCalledPoor(WiimoteLink(LinkQuality::kGood, seed), stall_s), 0) << seed;
      EXPECT_EQ(ShareCalledPoor(BoardLink(LinkQuality::kGood, seed), stall_s), 0) << seed;
    }
    EXPECT_GT(ShareCalledPoor(WiimoteLink(LinkQuality::kPoor, seed), 0), 0.95) << seed;
    EXPECT_GT(ShareCalledPoor(BoardLink(LinkQuality::kPoor, seed), 0), 0.95) << seed;
  }
}

TEST(Doctor, PutsErrorsFirst) {
  Facts facts = HealthyHost();
  Wiimote(facts).battery_low = true;
  facts.devices[1].state = stream::DeviceState::kStale;
  const auto findings = Examine(facts);
  ASSERT_EQ(findings.size(), 2u) << ToText(findings);
  EXPECT_EQ(findings[0].id, "device_silent");
  EXPECT_FALSE(Healthy(findings));
}

TEST(Doctor, LooksAtRightsOfTheDaemonNotOfThePerson) {
  Facts facts = HealthyHost();
  facts.hid[0].node_mode = 0600;
  facts.hid[0].node_uid = 995;  // The daemon's own: ann may not open it, and need not.
  EXPECT_EQ(Find(Examine(facts), "node_without_permission"), nullptr);
  facts.daemons.clear();
  EXPECT_NE(Find(Examine(facts), "node_without_permission"), nullptr);
}

TEST(Doctor, AsksForAGroupWhereTheRuleWasApplied) {
  Facts facts = HealthyHost();
  facts.daemons.clear();
  facts.user.gids = {1000};
  const auto findings = Examine(facts);
  const Finding* finding = Find(findings, "node_without_permission");
  ASSERT_NE(finding, nullptr);
  EXPECT_THAT(finding->remedy, HasSubstr("usermod -aG footing ann"));
}

TEST(Doctor, SendsWhoMayNotReachTheServiceToItsGroup) {
  Facts facts = HealthyHost();
  facts.footingd_reached = false;
  facts.footingd_trouble = "nothing answers";
  EXPECT_THAT(Find(Examine(facts), "footingd_not_running")->remedy, HasSubstr("--connect"));
  facts.user.gids = {1000};
  EXPECT_THAT(Find(Examine(facts), "footingd_not_running")->remedy,
              HasSubstr("usermod -aG footing ann"));
}

TEST(Doctor, MakesTheGroupBeforeTheRuleThatNamesIt) {
  Facts facts = HealthyHost();
  facts.udev_rules.clear();
  EXPECT_EQ(Find(Examine(facts), "udev_rule_missing")->remedy.find("groupadd"), std::string::npos);
  facts.footing_gid.reset();
  EXPECT_THAT(Find(Examine(facts), "udev_rule_missing")->remedy, HasSubstr("groupadd"));
}

TEST(Doctor, TakesFiveDevicesForTooManyOnlyWithJitter) {
  Facts facts = HealthyHost();
  facts.adapters[0].links = 5;
  EXPECT_EQ(Find(Examine(facts), "too_many_devices"), nullptr);
  Wiimote(facts).jitter_ms = 12;
  EXPECT_NE(Find(Examine(facts), "too_many_devices"), nullptr);
}

TEST(Doctor, DoesNotWorryAboutBlueZWhileADeviceLives) {
  Facts facts = HealthyHost();
  facts.bluez_version = "5.79-2";
  const auto findings = Examine(facts);
  ASSERT_NE(Find(findings, "bluez_pairing_regression"), nullptr);
  EXPECT_EQ(Find(findings, "bluez_pairing_regression")->severity, Severity::kNote);
  facts.bluez_version = "nonsense";
  EXPECT_THAT(Examine(facts), IsEmpty());
}

TEST(Doctor, DoesNotJudgeALinkAfterAFewReports) {
  Facts facts = HealthyHost();
  Wiimote(facts).reports = 20;
  Wiimote(facts).report_rate_hz = 5;
  EXPECT_THAT(Examine(facts), IsEmpty());
}

TEST(Doctor, TellsFindingsAsJson) {
  Facts facts = HealthyHost();
  facts.adapters[0].blocked_soft = true;
  const auto out = ToJson(Examine(facts));
  EXPECT_EQ(out["ok"], false);
  EXPECT_EQ(out["findings"][0]["id"], "adapter_blocked");
  EXPECT_EQ(out["findings"][0]["severity"], "error");
  EXPECT_EQ(out["findings"][0]["where"], "hci0");
  EXPECT_EQ(out["findings"][0]["remedy"], "rfkill unblock bluetooth");
}

}  // namespace
}  // namespace footing::ctl::doctor
