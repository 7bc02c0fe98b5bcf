// The names by which the service may be called, and the pages that may call it.
#include "server/access/sites.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tunewright::server {
namespace {

TEST(SitesTest, OnLoopbackItAnswersToItsAddressAndToLoopbackNames) {
    const Sites sites({.listen_host = "127.0.0.1"});
    for (const char* host : {"127.0.0.1:8080", "127.0.0.1", "localhost:80", "LOCALHOST", "[::1]:8080", "127.1.2.3",
                             "a.localhost", "localhost."})
        EXPECT_TRUE(sites.serves(host)) << host;
    for (const char* host : {"evil.example:8080", "10.0.0.7", "[fe80::1]", "127.evil.example", "localhost.evil.example",
                             "", "[::1", "127.0.0.1.evil.example"})
        EXPECT_FALSE(sites.serves(host)) << host;
}

TEST(SitesTest, OnEveryAddressItAnswersToAnyAddressButToNoName) {
    for (const char* listen : {"0.0.0.0", "::"}) {
        const Sites sites({.listen_host = listen});
        EXPECT_TRUE(sites.serves("10.0.0.7:8080") && sites.serves("[fe80::1]:8080") && sites.serves("localhost"));
        EXPECT_FALSE(sites.serves("plant.example") || sites.serves("10.0.0.7.evil.example"));
    }
}

TEST(SitesTest, NamesThatAreGivenAreItsOwn) {
    const Sites sites({.listen_host = "127.0.0.1", .allowed_hosts = {"Plant.Example", "[2001:db8::1]"}});
    EXPECT_TRUE(sites.serves("plant.example:443") && sites.serves("PLANT.EXAMPLE") && sites.serves("[2001:db8::1]:80"));
    EXPECT_FALSE(sites.serves("x.plant.example"));
    EXPECT_TRUE(Sites({.allowed_hosts = {"*"}}).serves("anything.example"));
    EXPECT_THROW(Sites({.allowed_hosts = {"http://plant.example"}}), std::invalid_argument);
}

TEST(SitesTest, APageMayCallWhereItCameFrom) {
    const Sites sites({.listen_host = "127.0.0.1", .allowed_hosts = {"plant.example"}});
    EXPECT_TRUE(sites.may_call("http://127.0.0.1:8080", "127.0.0.1:8080"));
    EXPECT_TRUE(sites.may_call("https://plant.example", "10.0.0.7:8080"));  // a proxy that writes its own Host
    for (const char* origin : {"http://evil.example", "http://127.0.0.1:9000", "null", "127.0.0.1:8080", ""})
        EXPECT_FALSE(sites.may_call(origin, "127.0.0.1:8080")) << origin;
}

TEST(SitesTest, BehindAProxyThePortMayBeLost) {
    const Sites behind({.listen_host = "0.0.0.0", .behind_proxy = true}), direct({.listen_host = "0.0.0.0"});
    EXPECT_TRUE(behind.may_call("https://plant.example:8443", "plant.example"));
    EXPECT_FALSE(direct.may_call("https://plant.example:8443", "plant.example"));
    EXPECT_FALSE(behind.may_call("https://evil.example", "plant.example"));
}

TEST(SitesTest, SitesThatAreAllowedMayCall) {
    const Sites sites({.cors_origins = {"https://a.example"}});
    EXPECT_TRUE(sites.may_call("https://a.example", "127.0.0.1:8080") && sites.is_allowed_site("https://a.example"));
    EXPECT_FALSE(sites.is_allowed_site("http://a.example") || sites.is_allowed_site("https://a.example.evil.example"));
    EXPECT_TRUE(Sites({.cors_origins = {"*"}}).may_call("null", "127.0.0.1:8080"));
    for (const char* origin : {"a.example", "https://a.example/", ""})
        EXPECT_THROW(Sites({.cors_origins = {origin}}), std::invalid_argument) << origin;
}

}  // namespace
}  // namespace tunewright::server
