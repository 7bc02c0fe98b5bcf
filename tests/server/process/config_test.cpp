// The settings at the start: sizes, times, and options that exclude each other.
#include "server/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace tunewright::server {
namespace {

using testing::HasSubstr;

std::string refusal(const Config& config) {
    try {
        check_config(config);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Config, SizesAreMebibytesUnlessAUnitOrManyDigitsSayOtherwise) {
    EXPECT_EQ(parse_size("8"), 8U << 20);
    EXPECT_EQ(parse_size("1.5"), 3U << 19);
    EXPECT_EQ(parse_size("512KiB"), 512U << 10);
    EXPECT_EQ(parse_size("8MiB"), 8U << 20);
    EXPECT_EQ(parse_size("2GiB"), 2ULL << 30);
    EXPECT_EQ(parse_size("4096B"), 4096U);
    EXPECT_EQ(parse_size("8388608"), 8U << 20);
    for (const std::string bad : {"", "MiB", "8 bananas", "-8", "8mb", "0", "1B", "1e99", "nan", "9999999GiB"})
        EXPECT_THROW(parse_size(bad), std::invalid_argument) << bad;
}

TEST(Config, TimesAreSecondsUnlessAUnitSaysOtherwise) {
    EXPECT_EQ(parse_duration("10"), 10);
    EXPECT_EQ(parse_duration("0"), 0);
    EXPECT_EQ(parse_duration("2.5s"), 2.5);
    EXPECT_EQ(parse_duration("500ms"), 0.5);
    EXPECT_EQ(parse_duration("5min"), 300);
    EXPECT_EQ(parse_duration("5m"), 300);
    EXPECT_EQ(parse_duration("12h"), 43'200);
    EXPECT_EQ(parse_duration("7d"), 604'800);
    for (const std::string bad : {"", "s", "10 weeks", "-1", "inf", "nan", "1e13"})
        EXPECT_THROW(parse_duration(bad), std::invalid_argument) << bad;
}

TEST(Config, TheDefaultsGoTogether) { EXPECT_EQ(refusal({}), ""); }

TEST(Config, BeyondLoopbackItTakesKeysOrAWord) {
    for (const std::string listen : {"0.0.0.0:80", ":80", "[::]:80", "192.168.1.5:80", "plant-server:80"}) {
        Config config;
        config.listen = listen;
        EXPECT_THAT(refusal(config), HasSubstr("--allow-anonymous")) << listen;
        config.allow_anonymous = true;
        EXPECT_EQ(refusal(config), "") << listen;
        config.allow_anonymous = false;
        config.auth = "keys";
        config.keys = "/etc/keys";
        EXPECT_EQ(refusal(config), "") << listen;
    }
    for (const std::string listen : {"127.0.0.1:80", "127.1.2.3:80", "localhost:80", "[::1]:80"}) {
        Config config;
        config.listen = listen;
        EXPECT_EQ(refusal(config), "") << listen;
    }
}

TEST(Config, RolesThatShareAStoreNeedOneThatCanBeShared) {
    for (const std::string role : {"api", "worker"}) {
        Config config;
        config.role = role;
        EXPECT_THAT(refusal(config), HasSubstr("postgresql://")) << role;
        config.store = "postgresql://localhost/tunewright";
        EXPECT_EQ(refusal(config), "") << role;
    }
    Config config;
    config.role = "boss";
    EXPECT_THAT(refusal(config), HasSubstr("all, api or worker"));
}

TEST(Config, KeysAndTheirFileComeTogether) {
    Config config;
    config.auth = "keys";
    EXPECT_THAT(refusal(config), HasSubstr("--keys FILE"));
    config.auth = "none";
    config.keys = "/etc/keys";
    EXPECT_THAT(refusal(config), HasSubstr("--auth keys"));
    config.auth = "passwords";
    EXPECT_THAT(refusal(config), HasSubstr("none or keys"));
}

TEST(Config, TheLongestTimeOutIsNotShorterThanTheUsualOne) {
    Config config;
    config.job_timeout_s = 100;
    config.max_timeout_s = 60;
    EXPECT_THAT(refusal(config), HasSubstr("--max-timeout"));
}

}  // namespace
}  // namespace tunewright::server
