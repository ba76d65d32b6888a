#include "common/net/discovery.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <cstdlib>

namespace footing::discovery {
namespace {

TEST(Discovery, AServiceComesBackOutOfItsTextRecord) {
  const Service sent{"lab 3", "footingd", 7450, true, "sha256:" + std::string(64, 'a')};
  Service read;
  ReadTextRecord(TextRecord(sent), read);
  EXPECT_EQ(read.program, sent.program);
  EXPECT_TRUE(read.tls);
  EXPECT_EQ(read.fingerprint, sent.fingerprint);
}

TEST(Discovery, WhatAnybodyMaySendIsShortAndPrintable) {
  Service read;
  ReadTextRecord({"program=\x1b[31mfoo\n", "tls=yes", "fingerprint=" + std::string(5000, 'x'), "=",
                  "", "port=1", std::string("tls\0=1", 6)},
                 read);
  EXPECT_EQ(read.program, "?[31mfoo?");
  EXPECT_FALSE(read.tls);
  EXPECT_EQ(read.fingerprint.size(), 80u);
  EXPECT_EQ(read.port, 0);
}

TEST(Discovery, OnlyPortsBeyondThisHostAreAdvertisedAndOnlyUnderAName) {
  boost::asio::io_context io;
  transport::ServerOptions options;
  options.server_id = "footingd";
  transport::Server server(io, options, {});
  transport::Address loopback;
  loopback.kind = transport::Address::Kind::kTcp;
  loopback.host = "127.0.0.1";
  ASSERT_TRUE(server.Listen(loopback).ok());
  EXPECT_TRUE(ServicesOf(server, 1, "lab", "footingd").empty());
}

TEST(Discovery, WithoutASystemBusThereIsOneLineAndNothingElse) {
  ASSERT_EQ(setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/nonexistent/bus", 1), 0);
  const auto found = Browse(0.1);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().message,
            "no system bus: No such file or directory; name the server's address with --connect");
  boost::asio::io_context io;
  {
    const Advertiser advertiser(io, {{"lab", "footingd", 7450, true, ""}});
    const Advertiser nothing(io, {});
    io.poll();
  }
  EXPECT_EQ(io.run(), 0u);  // Nothing of it is left.
}

}  // namespace
}  // namespace footing::discovery
