#include "clients/log/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "footing/v1/character.pb.h"
#include "footing/v1/device.pb.h"
#include "footing/v1/sensor.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::log_client {
namespace {

std::string Rows(const CsvTable& table, const google::protobuf::Message& message) {
  std::string rows;
  table.AppendRows(
      message, [](const auto*) { return ""; }, [](const auto*) { return ""; }, rows);
  return rows;
}

TEST(CsvTable, AMessageWithoutAListIsOneRow) {
  v1::Gap gap;
  gap.set_from_sequence(3);
  gap.set_to_sequence(5);
  gap.set_reason(v1::Gap::REASON_QUEUE_FULL);
  CsvTable table(*gap.GetDescriptor());
  ASSERT_TRUE(table.Learn(gap).ok());
  EXPECT_EQ(table.Header(), "from_sequence,to_sequence,reason");
  EXPECT_EQ(Rows(table, gap), "3,5,REASON_QUEUE_FULL\n");
}

TEST(CsvTable, TheFirstListGivesARowEach) {
  v1::RawReports reports;
  reports.add_reports()->set_report(std::string("\x31\x0a", 2));
  reports.mutable_reports(0)->set_device(1);
  reports.add_reports()->set_to_device(true);
  CsvTable table(*reports.GetDescriptor());
  ASSERT_TRUE(table.Learn(reports).ok());
  EXPECT_EQ(table.Header(), "device,received_ns,report,to_device,simulated,feature,true_ns");
  EXPECT_EQ(Rows(table, reports), "1,0,310a,0,0,0,0\n0,0,,1,0,0,0\n");
}

TEST(CsvTable, ListsWithinARowAreNumberedAndPaddedToTheLongest) {
  v1::CharacterFrame two;
  *two.mutable_world() += 'w';
  two.add_characters()->add_contacts()->set_touching(true);
  two.mutable_characters(0)->add_contacts()->set_normal_force_n(2.5);
  v1::CharacterFrame one;
  one.add_characters()->add_contacts();
  CsvTable table(*two.GetDescriptor());
  ASSERT_TRUE(table.Learn(two).ok());
  ASSERT_TRUE(table.Learn(one).ok());
  EXPECT_EQ(
      table.Header(),
      "world,step,time_s,overruns,state_hash,lease_holder,character,rig,valid,contacts_0_touching,"
      "contacts_0_normal_force_n,contacts_1_touching,contacts_1_normal_force_n,"
      "simulated_input");
  EXPECT_EQ(Rows(table, two), "w,0,0,0,0,,0,,0,1,0,0,2.5,0\n");
  EXPECT_EQ(Rows(table, one), ",0,0,0,0,,0,,0,0,0,,,0\n");
}

TEST(CsvTable, WhatAMessageDoesNotHaveIsAnEmptyCell) {
  v1::MotionSamples samples;
  samples.add_samples()->mutable_specific_force_mps2()->set_x(0.1);
  samples.add_samples();
  CsvTable table(*samples.GetDescriptor());
  ASSERT_TRUE(table.Learn(samples).ok());
  EXPECT_THAT(table.Header(), testing::HasSubstr("specific_force_mps2_x,specific_force_mps2_y"));
  EXPECT_EQ(Rows(table, samples),
            "0,0,0,0,0.1,0,0,0,0,0,0,0,0,0,0,0\n0,0,0,0,,,,0,0,0,0,0,0,0,0,0\n");
}

TEST(CsvTable, ANumberThatIsOptionalAndAbsentIsNotZero) {
  v1::Events events;
  events.add_events()->mutable_marker()->set_value(0);
  events.add_events()->mutable_marker()->set_client("c");
  CsvTable table(*events.GetDescriptor());
  ASSERT_TRUE(table.Learn(events).ok());
  EXPECT_THAT(table.Header(), testing::EndsWith(",marker_value,marker_received_ns,marker_client"));
  EXPECT_THAT(Rows(table, events), testing::HasSubstr(",0,0,\n"));
  EXPECT_THAT(Rows(table, events), testing::EndsWith(",,0,c\n"));
}

TEST(CsvTable, TextIsQuotedWhereItMustBeAndNumbersThatAreNoneAreEmpty) {
  v1::DeviceStatusList list;
  v1::DeviceStatus& status = *list.add_devices();
  status.set_note("press \"sync\", then wait\nfor it");
  status.set_jitter_ms(std::numeric_limits<double>::quiet_NaN());
  CsvTable table(*list.GetDescriptor());
  ASSERT_TRUE(table.Learn(list).ok());
  const std::string rows = Rows(table, list);
  EXPECT_THAT(rows, testing::HasSubstr(",\"press \"\"sync\"\", then wait\nfor it\","));
  EXPECT_THAT(rows, testing::Not(testing::HasSubstr("nan")));
}

TEST(CsvTable, TooManyColumnsAreRefused) {
  v1::Skeletons skeletons;
  v1::Skeleton& skeleton = *skeletons.add_skeletons();
  for (std::size_t k = 0; k <= CsvTable::kMostColumns; ++k) skeleton.add_contact_points();
  CsvTable table(*skeletons.GetDescriptor());
  const Result<void> learned = table.Learn(skeletons);
  ASSERT_FALSE(learned.ok());
  EXPECT_EQ(learned.error().kind, ErrorKind::kInvalidData);
}

TEST(CsvTable, TheUnitOfAColumnStandsInItsName) {
  for (const auto& [name, unit, last] : std::vector<std::array<const char*, 3>>{
           {"specific_force_mps2_x", "m/s2", "specific_force_x_mps2"},
           {"links_12_position_m_x", "m", "links_12_position_x_m"},
           {"total_n", "N", "total_n"},
           {"cop_x_m", "m", "cop_x_m"},
           {"body_link_sd_m_3", "m", "body_link_sd_3_m"},
           {"links_0_orientation_w", "", "links_0_orientation_w"},
           {"n", "", "n"},
           {"device", "", "device"}}) {
    EXPECT_EQ(UnitOf(name), unit) << name;
    EXPECT_EQ(UnitLast(name), last);
    EXPECT_EQ(UnitOf(last), unit) << last;
  }
}

TEST(CsvTable, AHashIsNoNumber) {
  v1::CharacterFrame frame;
  frame.set_state_hash(UINT64_MAX);
  frame.set_step(7);
  CsvTable table(*frame.GetDescriptor());
  ASSERT_TRUE(table.Learn(frame).ok());
  const auto names = table.NumberNames();
  EXPECT_THAT(names, testing::Contains("step"));
  EXPECT_THAT(names, testing::Not(testing::Contains("state_hash")));
  EXPECT_EQ(table.Numbers(frame, nullptr).size(), names.size());
}

}  // namespace
}  // namespace footing::log_client
