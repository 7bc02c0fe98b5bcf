// The file of keys while the service runs: a revoked key stays revoked, whatever happens to the file.
#include "server/access/keys.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "api/json/digest.h"

namespace tunewright::server {
namespace {

class KeyRingTest : public testing::Test {
protected:
    KeyRingTest() {
        std::string name = "/tmp/tunewright-keys-XXXXXX";
        folder_ = ::mkdtemp(name.data());
        write(line("ann") + line("bob"));
        ring_ = std::make_unique<KeyRing>(path(), [this] { return now_; });
    }
    ~KeyRingTest() override { std::filesystem::remove_all(folder_); }

    std::string path() const { return folder_ + "/keys"; }
    static std::string line(const std::string& name) {
        return name + " sha256:" + api::sha256_hex("tw_" + name) + "\n";
    }
    void write(const std::string& text) const { std::ofstream(path(), std::ios::trunc) << text; }
    void later(std::chrono::seconds by = std::chrono::seconds(2)) { now_ += by; }
    bool admits(const std::string& name) { return ring_->holder_of("tw_" + name) == KeyHolder{name, false}; }

    std::string folder_;
    KeyRing::Clock::time_point now_{std::chrono::hours(1)};
    std::unique_ptr<KeyRing> ring_;
};

TEST_F(KeyRingTest, FollowsLinesThatAreAddedAndDeleted) {
    EXPECT_TRUE(admits("ann"));
    EXPECT_FALSE(admits("eve"));
    write(line("bob") + line("eve"));
    later();
    EXPECT_FALSE(admits("ann"));
    EXPECT_TRUE(admits("bob") && admits("eve") && ring_->usable());
}

TEST_F(KeyRingTest, AFileOfTheSameSizeAndTimeThatTakesItsPlaceIsReadAgain) {
    const auto written = std::filesystem::last_write_time(path());
    const std::string other = path() + ".new";
    std::ofstream(other) << line("eve") + line("bob");
    std::filesystem::last_write_time(other, written);
    ASSERT_EQ(std::filesystem::file_size(other), std::filesystem::file_size(path()));
    std::filesystem::rename(other, path());
    later();
    EXPECT_FALSE(admits("ann"));
    EXPECT_TRUE(admits("eve") && admits("bob"));
    write(line("bob") + line("ann"));
    std::filesystem::last_write_time(path(), written);
    later();
    EXPECT_FALSE(admits("eve")) << "written over, in place";
}

TEST_F(KeyRingTest, AByteOrderMarkIsNoPartOfTheFirstName) {
    write("\xef\xbb\xbf" + line("ann") + line("eve"));
    later();
    EXPECT_TRUE(admits("ann") && admits("eve") && ring_->usable());
}

TEST_F(KeyRingTest, AnEmptiedFileAdmitsNobody) {
    write("# nobody\n");
    later();
    EXPECT_FALSE(admits("ann") || admits("bob"));
    EXPECT_TRUE(ring_->usable());
}

TEST_F(KeyRingTest, ADeletedFileAdmitsNobodyAndIsNotUsableUntilItIsBack) {
    std::filesystem::remove(path());
    later();
    EXPECT_FALSE(ring_->usable());
    EXPECT_FALSE(admits("ann"));
    write(line("bob"));
    later();
    EXPECT_TRUE(ring_->usable() && admits("bob"));
    EXPECT_FALSE(admits("ann"));
}

TEST_F(KeyRingTest, AFileThatCannotBeReadAdmitsNobody) {
    std::filesystem::remove(path());
    std::filesystem::create_directory(path());
    later();
    EXPECT_FALSE(ring_->usable() || admits("ann"));
}

TEST_F(KeyRingTest, AHalfWrittenFileKeepsTheLastGoodKeysForTenSeconds) {
    write(line("bob") + "ann sha2");
    later();
    EXPECT_TRUE(admits("ann") && admits("bob") && ring_->usable());
    later(std::chrono::seconds(9));
    EXPECT_TRUE(admits("ann"));
    later(std::chrono::seconds(2));
    EXPECT_FALSE(admits("ann") || admits("bob"));
    EXPECT_FALSE(ring_->usable());
    write(line("bob") + line("eve"));
    later();
    EXPECT_TRUE(admits("eve") && ring_->usable());
}

TEST_F(KeyRingTest, EachFurtherFaultyWriteDoesNotGrantMoreTime) {
    for (int i = 0; i < 6; ++i) {
        write(line("bob") + std::string(static_cast<std::size_t>(i + 1), 'x'));
        later();
        admits("bob");
    }
    EXPECT_FALSE(admits("bob"));
}

TEST(NamedLines, WhatIsAddedStandsOnALineOfItsOwn) {
    const std::string path = testing::TempDir() + "/keys_without_end";
    for (const char* before : {"", "a 1", "a 1\n"}) {
        std::ofstream(path, std::ios::binary) << before;
        ASSERT_TRUE(append_line(path, "b 2\n"));
        const std::string text = text_of_lines(path).value_or("");
        const auto lines = named_lines(text);
        ASSERT_EQ(lines.size(), std::string_view(before).empty() ? 1u : 2u) << before;
        EXPECT_EQ(lines.back().name, "b");
    }
    EXPECT_FALSE(text_of_lines("/dev/zero"));
}

TEST_F(KeyRingTest, TheServiceDoesNotStartWithoutAKey) {
    write("");
    EXPECT_THROW(KeyRing{path()}, std::invalid_argument);
    EXPECT_THROW(KeyRing{path() + "-none"}, std::invalid_argument);
}

}  // namespace
}  // namespace tunewright::server
