// The log around its end.
#include <gtest/gtest.h>
#include <unistd.h>

#include "server/log.h"

namespace tunewright::server {
namespace {

// A process that stops does not wait for every thread.
TEST(Log, LinesAfterItsEndAreLostAndNoFault) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto whole_life = [] {
        start_log("text", "info");
        log_info("in time");
        stop_log();
        log_error("too late");
        ::_exit(0);
    };
    EXPECT_EXIT(whole_life(), testing::ExitedWithCode(0), "info in time\n$");
}

}  // namespace
}  // namespace tunewright::server
