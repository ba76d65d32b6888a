#include "common/net/device_link.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "common/net/framing.h"
#include "common/net/listener.h"
#include "tests/common/net/io_fixture.h"

namespace footing::device_link {
namespace {

/// footingd's side: takes what is sent.
class DeviceLinkTest : public transport::IoFixture {
 protected:
  void Listen() {
    auto listener = transport::Listener::Open(io_, UnixAddress(), [this](transport::Socket socket) {
      transport::FramedHandlers handlers;
      handlers.on_frame = [this](std::string_view payload) {
        v1::DeviceEnvelope message;
        ASSERT_TRUE(message.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
        received_.push_back(message);
      };
      handlers.on_close = [this](const std::string&) { ++closed_; };
      peer_ = std::make_unique<transport::FramedConnection>(
          std::move(socket), transport::FramedLimits(), std::move(handlers));
      peer_->Start();
      ++accepted_;
    });
    ASSERT_TRUE(listener) << listener.error().message;
    listener_ = std::move(listener).value();
  }

  Options Counting() {
    Options options{.to = UnixAddress()};
    options.on_open = [this] { ++opened_; };
    options.on_close = [this] { ++lost_; };
    options.on_message = [this](const v1::DeviceEnvelope& message) {
      messages_.push_back(message);
    };
    return options;
  }

  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<transport::FramedConnection> peer_;
  std::vector<v1::DeviceEnvelope> received_, messages_;
  int accepted_ = 0, closed_ = 0, opened_ = 0, lost_ = 0;
};

TEST_F(DeviceLinkTest, DialsUntilSomebodyListensAndAgainAfterALoss) {
  DeviceLink link(io_, Counting());
  link.Start();
  io_.run_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(link.open());
  Listen();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  peer_->Close();
  ASSERT_TRUE(RunUntil([&] { return lost_ == 1; }));
  ASSERT_TRUE(RunUntil([&] { return opened_ == 2 && accepted_ == 2; }));
  link.Stop("done");
  ASSERT_TRUE(RunUntil([&] { return closed_ == 1; }));
  io_.run_for(std::chrono::milliseconds(300));
  EXPECT_EQ(accepted_, 2) << "nobody dials after the end";
  EXPECT_EQ(lost_, 1);
}

TEST_F(DeviceLinkTest, WhatHasNoConnectionIsDroppedAndCounted) {
  DeviceLink link(io_, Counting());
  EXPECT_FALSE(link.Send(stream::HandFrame{}));
  Listen();
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  EXPECT_TRUE(link.Send(stream::HandFrame{}));
  ASSERT_TRUE(RunUntil([&] { return received_.size() == 1; }));
  EXPECT_TRUE(received_.front().has_hand_frame());
  EXPECT_EQ(link.sent(), 1u);
  EXPECT_EQ(link.dropped(), 1u);
}

TEST_F(DeviceLinkTest, PassesOnWhatIsSentButARefusalGoesToTheLog) {
  Listen();
  DeviceLink link(io_, Counting());
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  v1::DeviceEnvelope refused, output;
  refused.mutable_refused()->set_reason("there is one already");
  output.mutable_output()->set_slot(3);
  peer_->Send(refused.SerializeAsString());
  peer_->Send("not an envelope");
  peer_->Send(output.SerializeAsString());
  ASSERT_TRUE(RunUntil([&] { return !messages_.empty(); }));
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_EQ(messages_.front().output().slot(), 3u);
}

}  // namespace
}  // namespace footing::device_link
