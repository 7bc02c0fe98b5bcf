// Signatures and the file of secrets. The expected signatures are independent: from Python's hmac, and the example of
// Standard Webhooks' own libraries.
#include "server/notify/signature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "api/json/digest.h"
#include "server/notify/policy.h"
#include "server/notify/secrets.h"

namespace tunewright::server {
namespace {

using testing::HasSubstr;

const std::string kSecret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

TEST(Signature, IsTheOneOfTheStandardsExample) {
    const SignedNote note{"msg_p5jXN8AQM9LWM0D4loKWxJek", 1614265330, "{\"test\": 2432232314}"};
    EXPECT_EQ(signature_of(note, {*secret_bytes(kSecret)}), "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
}

TEST(Signature, IsOneForEachSecret) {
    const SignedNote note{"evt_1_2", 1700000000, "{}"};
    const std::string all = signature_of(note, {std::string(32, 'k'), std::string(24, 'x')});
    // base64.b64encode(hmac.new(b"k" * 32, b"evt_1_2.1700000000.{}", "sha256").digest())
    EXPECT_EQ(all, "v1,NUfsEP7hk3YBTilm9lqy+f2nSXtqksf7XQ/knErRV9w= v1,1TGAhkT25C748hLM36C4sL6K5WEwIwUCoDVMahubaT8=");
}

TEST(Signature, HmacIsThatOfRfc4231) {
    const std::string mac = api::hmac_sha256("Jefe", "what do ya want for nothing?");
    EXPECT_EQ(api::base64(mac), "W9zBRr9gdU5qBCQmCJV1x1oAPwidJzmDnexYuWTsOEM=");
}

TEST(Signature, ReadsBase64AsItIsWritten) {
    for (const std::string& bytes :
         {std::string(), std::string("a"), std::string("ab"), std::string("abc"), std::string("\0\xff", 2)})
        EXPECT_EQ(api::base64_bytes(api::base64(bytes)), bytes);
    for (const char* text : {"YQ", "YQ=", "YR==", "YQ==\n", " YQ==", "Y===", "====", "Y*==", "YQ==YQ=="})
        EXPECT_FALSE(api::base64_bytes(text)) << text;
}

TEST(Signature, SecretsHaveTwentyFourToSixtyFourBytes) {
    const auto of = [](std::size_t bytes) { return "whsec_" + api::base64(std::string(bytes, 'x')); };
    EXPECT_EQ(secret_bytes(of(24))->size(), 24u);
    EXPECT_EQ(secret_bytes(of(64))->size(), 64u);
    for (const std::string& text :
         {of(23), of(65), std::string("whsec_"), api::base64(std::string(32, 'x')), std::string("whsec_?")})
        EXPECT_FALSE(secret_bytes(text)) << text;
    EXPECT_EQ(secret_bytes(new_secret())->size(), 32u);
    EXPECT_NE(new_secret(), new_secret());
}

class SecretsTest : public testing::Test {
protected:
    SecretsTest() {
        std::string name = "/tmp/tunewright-secrets-XXXXXX";
        folder_ = ::mkdtemp(name.data());
        write("# ours\n\n" + line("one", 'a') + "two\t" + secret('b') + "\r\n");
    }
    ~SecretsTest() override { std::filesystem::remove_all(folder_); }

    std::string path() const { return folder_ + "/secrets"; }
    static std::string secret(char c) { return "whsec_" + api::base64(std::string(24, c)); }
    static std::string line(const std::string& name, char c) { return name + " " + secret(c) + "\n"; }
    void write(const std::string& text) const { std::ofstream(path(), std::ios::trunc) << text; }
    void later(std::chrono::seconds by = std::chrono::seconds(2)) { now_ += by; }
    Secrets opened() {
        return Secrets(path(), [this] { return now_; });
    }

    std::string folder_;
    Secrets::Clock::time_point now_{std::chrono::hours(1)};
};

using Bytes = std::vector<std::string>;

TEST_F(SecretsTest, AreFoundByTheirNames) {
    Secrets secrets = opened();
    EXPECT_EQ(secrets.of("one"), Bytes{std::string(24, 'a')});
    EXPECT_EQ(secrets.of("two"), Bytes{std::string(24, 'b')});
    EXPECT_EQ(secrets.of(""), Bytes{std::string(24, 'a')});
    EXPECT_EQ(secrets.of("three"), Bytes{});
}

TEST_F(SecretsTest, TwoOfOneNameBothSign) {
    write(line("one", 'n') + line("two", 'b') + line("one", 'a'));
    Secrets secrets = opened();
    EXPECT_EQ(secrets.of("one"), (Bytes{std::string(24, 'n'), std::string(24, 'a')}));
    EXPECT_EQ(secrets.of(""), secrets.of("one"));
}

TEST_F(SecretsTest, FollowTheFile) {
    Secrets secrets = opened();
    write(line("new", 'n'));
    later();
    EXPECT_EQ(secrets.of(""), Bytes{std::string(24, 'n')});
    write("new whsec_half");
    later();
    EXPECT_EQ(secrets.of(""), Bytes{std::string(24, 'n')});
    later(WatchedFile::kMaxBrokenTime);
    EXPECT_EQ(secrets.of(""), Bytes{});
    write(line("new", 'm'));
    later();
    EXPECT_EQ(secrets.of("new"), Bytes{std::string(24, 'm')});
    std::filesystem::remove(path());
    later();
    EXPECT_EQ(secrets.of("new"), Bytes{});
}

TEST_F(SecretsTest, AFileThatCannotBeUsedNamesTheLine) {
    const auto refusal = [this] {
        try {
            opened();
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    write(line("one", 'a') + "\ntwo whsec_short\n");
    EXPECT_THAT(refusal(), HasSubstr("line 3 must be NAME whsec_BASE64"));
    write("# none\n");
    EXPECT_THAT(refusal(), HasSubstr("it has no secret; `tunewright secret NAME --file FILE` adds one"));
    std::filesystem::remove(path());
    EXPECT_THAT(refusal(), HasSubstr("it cannot be read"));
}

TEST_F(SecretsTest, WhatIsNotAllowedIsRefusedWithItsNameAndItsCure) {
    NotifyPolicy policy({"https://hooks.example.com/in"}, path());
    EXPECT_FALSE(policy.refuse({"https://hooks.example.com/in/x?token=1", "two"}, "notify."));
    const auto both = policy.refuse({"https://evil.example/x", "three"}, "notify.");
    ASSERT_TRUE(both && both->errors.size() == 2);
    EXPECT_EQ(both->status, 422);
    EXPECT_EQ(both->errors[0].pointer, "/notify/url");
    EXPECT_THAT(both->errors[0].detail, HasSubstr("notify.url is \"https://evil.example/x\"; the operator"));
    EXPECT_THAT(both->errors[0].detail, HasSubstr("--notify-target https://evil.example."));
    EXPECT_EQ(both->errors[1].pointer, "/notify/secret_id");
    EXPECT_EQ(policy.refuse({"https://evil.example/x", ""}, "notify_")->errors[0].pointer, "/notify_url");
    NotifyPolicy without({"https://hooks.example.com"}, "");
    EXPECT_THAT(without.refuse({"https://hooks.example.com", ""}, "notify.")->errors[0].detail,
                HasSubstr("no secret for signatures"));
    NotifyPolicy nowhere({}, path());
    EXPECT_TRUE(nowhere.refuse({"https://hooks.example.com", ""}, "notify."));
    EXPECT_FALSE(nowhere.allows_any());
}

}  // namespace
}  // namespace tunewright::server
