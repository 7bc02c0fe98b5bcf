// Keys, rates and other sites: the requests that the gate admits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>

#include "api/json/digest.h"
#include "server/access/gate.h"

namespace tunewright::server {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

std::string line_of(const std::string& name, const std::string& key) {
    return name + " sha256:" + api::sha256_hex(key) + "\n";
}

/// A file that is deleted at the end of the test.
class File {
public:
    explicit File(const std::string& text)
        : path(testing::TempDir() + "keys-" + testing::UnitTest::GetInstance()->current_test_info()->name()) {
        write(text);
    }
    ~File() { std::remove(path.c_str()); }
    void write(const std::string& text) const { std::ofstream(path) << text; }
    std::string path;
};

http::Request request(const std::string& method, const std::string& path) {
    http::Request made;
    made.method = method;
    made.target = path;
    made.remote_addr = "10.0.0.7";
    for (std::size_t at = 1; at < path.size();) {
        const std::size_t slash = std::min(path.find('/', at), path.size());
        made.segments.push_back(path.substr(at, slash - at));
        at = slash + 1;
    }
    return made;
}

http::Request with(http::Request made, const std::string& name, const std::string& value) {
    made.headers.emplace(name, value);
    return made;
}

std::string header(const std::vector<std::pair<std::string, std::string>>& headers, const std::string& name) {
    for (const auto& [key, value] : headers)
        if (key == name) return value;
    return "";
}

TEST(Keys, LinesHaveANameAndADigestAndMayBeCommentedOrBlank) {
    const auto lines = parse_keys("# plant\n\n" + line_of("line-1", "a") + "  " + line_of("line-2", "b") + "\r\n");
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].name, "line-1");
    EXPECT_EQ(lines[1].digest, api::sha256_hex("b"));
}

TEST(Keys, ALineThatCannotBeReadIsNamedByItsNumber) {
    for (const std::string bad : {"a", "a md5:00", "a sha256:12", "two names sha256:00", "k\xc3\xa4y sha256:00"}) {
        try {
            parse_keys(line_of("good", "a") + bad + "\n");
            ADD_FAILURE() << bad;
        } catch (const std::invalid_argument& error) {
            EXPECT_THAT(error.what(), HasSubstr("line 2 must be NAME sha256:DIGEST")) << bad;
        }
    }
}

TEST(Keys, NewKeysDifferAndHave256Bits) {
    std::set<std::string> seen;
    for (int i = 0; i < 100; i++) seen.insert(new_key());
    EXPECT_EQ(seen.size(), 100U);
    EXPECT_EQ(seen.begin()->size(), 3U + 64U);
}

TEST(Keys, ARingKnowsItsKeysAndOnlyThose) {
    const File file(line_of("a", "tw_1") + line_of("b", "tw_2") + line_of("a", "tw_3"));
    KeyRing ring(file.path);
    EXPECT_EQ(ring.holder_of("tw_1"), (KeyHolder{"a", false}));
    EXPECT_EQ(ring.holder_of("tw_2"), (KeyHolder{"b", false}));
    EXPECT_EQ(ring.holder_of("tw_3"), (KeyHolder{"a", false}));
    for (const std::string wrong : {"", "tw_", "tw_4", "tw_1 ", "TW_1"}) EXPECT_FALSE(ring.holder_of(wrong)) << wrong;
    EXPECT_FALSE(ring.holder_of(api::sha256_hex("tw_1"))) << "a digest is not a key";
}

TEST(Keys, AFileWithoutKeysOrThatIsNotThereIsRefusedWithTheCure) {
    const File empty("# nobody yet\n");
    for (const std::string& path : {empty.path, empty.path + ".none"}) {
        try {
            KeyRing ring(path);
            ADD_FAILURE() << path;
        } catch (const std::invalid_argument& error) {
            EXPECT_THAT(error.what(), HasSubstr(path));
        }
    }
}

TEST(RateLimit, AfterItsBurstAClientGetsItsRate) {
    RateLimit limit(10, 5);
    const RateLimit::Time start{};
    for (int i = 0; i < 5; i++) EXPECT_FALSE(limit.refuse("a", start));
    const auto wait = limit.refuse("a", start);
    ASSERT_TRUE(wait);
    EXPECT_NEAR(wait->count(), 0.1, 1e-9);
    int passed = 0;
    for (int ms = 1; ms <= 10'000; ms++) passed += limit.refuse("a", start + milliseconds(ms)) ? 0 : 1;
    EXPECT_EQ(passed, 100);
}

TEST(RateLimit, ClientsDoNotTakeFromEachOther) {
    RateLimit limit(1, 1);
    const RateLimit::Time start{};
    EXPECT_FALSE(limit.refuse("a", start));
    EXPECT_TRUE(limit.refuse("a", start));
    EXPECT_FALSE(limit.refuse("b", start));
}

TEST(RateLimit, ManyClientsAreForgottenFromTheQuietestOn) {
    RateLimit limit(0.001, 1, 3);
    const RateLimit::Time start{};
    for (const char* client : {"a", "b", "c"}) limit.refuse(client, start);
    limit.refuse("a", start);
    limit.refuse("d", start);
    EXPECT_EQ(limit.clients(), 3U);
    EXPECT_TRUE(limit.refuse("a", start)) << "it called after b and c and is still known";
    EXPECT_FALSE(limit.refuse("b", start)) << "it was the quietest and starts anew";
}

TEST(Gate, WithoutKeysEverybodyPassesAndCountsByHisAddress) {
    Gate gate({});
    http::Request call = request("POST", "/v1/jobs");
    EXPECT_FALSE(gate.admit(call));
    EXPECT_EQ(call.client, "10.0.0.7");
    EXPECT_FALSE(call.owner);
}

TEST(Gate, WithKeysAllBelowV1AndTheMetricsNeedOne) {
    const File file(line_of("line-1", "tw_1"));
    GateSettings settings;
    settings.keys_file = file.path;
    Gate gate(settings);
    for (const std::string path : {"/v1/jobs", "/v1/jobs/x", "/v1/methods", "/metrics", "/v1"}) {
        http::Request call = request("GET", path);
        const auto refusal = gate.admit(call);
        ASSERT_TRUE(refusal) << path;
        EXPECT_EQ(refusal->status, 401);
        EXPECT_THAT(header(refusal->headers, "WWW-Authenticate"), HasSubstr("Bearer"));
    }
    for (const std::string path : {"/", "/assets/index.js", "/openapi.json", "/healthz", "/readyz"}) {
        http::Request call = request("GET", path);
        EXPECT_FALSE(gate.admit(call)) << path;
    }
    for (const std::string scheme : {"Bearer ", "bearer ", "BEARER   "}) {
        http::Request call = with(request("GET", "/v1/jobs"), "Authorization", scheme + "tw_1");
        EXPECT_FALSE(gate.admit(call)) << scheme;
        EXPECT_EQ(call.owner, "line-1");
        EXPECT_EQ(call.client, "key:line-1");
    }
    for (const std::string wrong : {"Bearer tw_2", "Basic tw_1", "Bearer", "Bearer ", "tw_1"}) {
        http::Request call = with(request("GET", "/v1/jobs"), "Authorization", wrong);
        const auto refusal = gate.admit(call);
        ASSERT_TRUE(refusal) << wrong;
        EXPECT_EQ(refusal->status, 401) << wrong;
    }
}

TEST(Gate, WhoTriesKeysIsSlowedDown) {
    const File file(line_of("line-1", "tw_1"));
    GateSettings settings;
    settings.keys_file = file.path;
    settings.rate = 0.001;
    settings.burst = 3;
    Gate gate(settings);
    std::vector<int> statuses;
    for (int i = 0; i < 5; i++) {
        http::Request call = with(request("GET", "/v1/jobs"), "Authorization", "Bearer guess" + std::to_string(i));
        statuses.push_back(gate.admit(call)->status);
    }
    EXPECT_THAT(statuses, testing::ElementsAre(401, 401, 401, 429, 429));
    http::Request known = with(request("GET", "/v1/jobs"), "Authorization", "Bearer tw_1");
    EXPECT_FALSE(gate.admit(known)) << "the key's own bucket is another one";
}

TEST(Gate, BeyondTheRateClientsAreToldWhenToComeBackAndProbesPass) {
    GateSettings settings;
    settings.rate = 0.1;
    settings.burst = 1;
    Gate gate(settings);
    http::Request first = request("GET", "/v1/jobs");
    http::Request second = first;
    http::Request probe = request("GET", "/healthz");
    EXPECT_FALSE(gate.admit(first));
    const auto refusal = gate.admit(second);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->status, 429);
    EXPECT_GE(std::stoi(header(refusal->headers, "Retry-After")), 9);
    EXPECT_THAT(refusal->body, HasSubstr("rate-limit"));
    for (int i = 0; i < 10; i++) EXPECT_FALSE(gate.admit(probe));
}

TEST(Gate, PagesOfOtherSitesMayNotCallUnlessTheyAreNamed) {
    GateSettings settings;
    settings.sites.cors_origins = {"https://plant.example"};
    Gate gate(settings);
    for (const std::string site : {"cross-site", "same-site"}) {
        http::Request call = with(request("POST", "/v1/jobs"), "Sec-Fetch-Site", site);
        const auto refusal = gate.admit(call);
        ASSERT_TRUE(refusal) << site;
        EXPECT_EQ(refusal->status, 403);
        EXPECT_EQ(header(call.answer_headers, "Access-Control-Allow-Origin"), "");
    }
    http::Request named =
        with(with(request("POST", "/v1/jobs"), "Sec-Fetch-Site", "cross-site"), "Origin", "https://plant.example");
    EXPECT_FALSE(gate.admit(named));
    EXPECT_EQ(header(named.answer_headers, "Access-Control-Allow-Origin"), "https://plant.example");
    http::Request other = with(request("GET", "/v1/jobs"), "Origin", "https://plant.example.evil.example");
    const auto refusal = gate.admit(other);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->status, 403);
    EXPECT_EQ(header(other.answer_headers, "Access-Control-Allow-Origin"), "");
    EXPECT_EQ(header(other.answer_headers, "Vary"), "Origin");
}

TEST(Gate, APreflightOfANamedSiteIsAnsweredWithoutAKey) {
    const File file(line_of("line-1", "tw_1"));
    GateSettings settings;
    settings.keys_file = file.path;
    settings.sites.cors_origins = {"https://plant.example"};
    Gate gate(settings);
    http::Request call = with(with(request("OPTIONS", "/v1/jobs"), "Origin", "https://plant.example"),
                              "Access-Control-Request-Method", "POST");
    const auto answer = gate.admit(call);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 204);
    EXPECT_THAT(header(answer->headers, "Access-Control-Allow-Headers"), HasSubstr("Authorization"));
}

TEST(Gate, ARequestKeepsAPlainIdOfItsOwnAndElseGetsOne) {
    Gate gate({});
    http::Request given = with(request("GET", "/"), "X-Request-Id", "trace-7.a_b");
    gate.admit(given);
    EXPECT_EQ(given.request_id, "trace-7.a_b");
    EXPECT_EQ(header(given.answer_headers, "X-Request-Id"), "trace-7.a_b");
    std::set<std::string> made;
    const std::vector<std::string> bad_ids = {"", "a b", "<script>", "x\"y", std::string(65, 'a')};
    for (const std::string& bad : bad_ids) {
        http::Request call = with(request("GET", "/"), "X-Request-Id", bad);
        gate.admit(call);
        EXPECT_NE(call.request_id, bad);
        made.insert(call.request_id);
    }
    EXPECT_EQ(made.size(), 5U);
}

TEST(Gate, OnlyBehindAProxyTheLastForwardedAddressIsTheClient) {
    const http::Request call = with(request("GET", "/v1/jobs"), "X-Forwarded-For", "1.2.3.4, 192.0.2.9");
    GateSettings settings;
    http::Request direct = call;
    Gate(settings).admit(direct);
    EXPECT_EQ(direct.client, "10.0.0.7");
    settings.behind_proxy = true;
    http::Request proxied = call;
    Gate(settings).admit(proxied);
    EXPECT_EQ(proxied.client, "192.0.2.9");
}

TEST(Gate, AProxysPortIsNoPartOfTheClientsAddress) {
    GateSettings settings;
    settings.behind_proxy = true;
    Gate gate(settings);
    const std::vector<std::pair<std::string, std::string>> forms = {{"192.0.2.9:51234", "192.0.2.9"},
                                                                    {"[2001:db8::7]:443", "2001:db8::7"},
                                                                    {"[2001:db8::7]", "2001:db8::7"},
                                                                    {"2001:db8::7", "2001:db8::7"},
                                                                    {"1.2.3.4, 192.0.2.9:7 ", "192.0.2.9"},
                                                                    {"[", "10.0.0.7"},
                                                                    {":80", "10.0.0.7"}};
    for (const auto& [written, client] : forms) {
        http::Request call = with(request("GET", "/v1/jobs"), "X-Forwarded-For", written);
        gate.admit(call);
        EXPECT_EQ(call.client, client) << written;
    }
}

}  // namespace
}  // namespace tunewright::server
