// The addresses that the service may be made to call: tricks that would lead elsewhere than the operator allows.
#include "server/notify/target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace tunewright::server {
namespace {

using testing::HasSubstr;

const Targets& allowed() {
    static const Targets targets({"https://hooks.example.com", "https://Paths.example.com:8443/a/b",
                                  "http://10.0.0.7:8080", "https://[2001:DB8::1]/", "https://tail.example.com/in/"});
    return targets;
}

bool allows(const std::string& url) {
    const auto read = parse_address(url);
    const auto* address = std::get_if<WebAddress>(&read);
    return address != nullptr && allowed().allow(*address);
}

TEST(Targets, AllowWhatLiesBelowThem) {
    for (const char* url :
         {"https://hooks.example.com", "https://hooks.example.com/", "https://hooks.example.com/x/y?z=1&u=http://a/b",
          "https://HOOKS.Example.com/x", "HTTPS://hooks.example.com/x", "https://hooks.example.com:443/x",
          "https://hooks.example.com?token=%41", "https://hooks.example.com/a.b/..c/%20/~x",
          "https://paths.example.com:8443/a/b", "https://paths.example.com:8443/a/b/",
          "https://paths.example.com:8443/a/b/c", "https://paths.example.com:8443/a/b?c", "http://10.0.0.7:8080/x",
          "https://[2001:db8:0::1]:443/x", "https://tail.example.com/in/", "https://tail.example.com/in/x"})
        EXPECT_TRUE(allows(url)) << url;
}

TEST(Targets, AllowNothingElse) {
    for (const char* url :
         {// Another host, whatever stands before or after its name.
          "https://evil.example", "https://hooks.example.com.evil.example/", "https://evil.hooks.example.com/",
          "https://hooks.example.com@evil.example/", "https://hooks.example.com:443@evil.example/",
          "https://user@hooks.example.com/", "https://hooks.example.com%40evil.example/",
          "https://hooks.example.com\\@evil.example/", "https://hooks.example.com\\.evil.example",
          "https://evil.example#@hooks.example.com/", "https://evil.example?@hooks.example.com/",
          "https://hooks.example.com#x", "https://hooks%2eexample.com/", "https://hooks.example.com./",
          "https://hooks..example.com/", "https://.hooks.example.com/", "https://hooks.example.com /",
          "https://hooks.example.com\t/", "https://hooks.example.com/\r\nHost: evil", "https://hooks.example.com/\n",
          "https://hooks.example.com/\x7f", "https://hooks.ex\xc3\xa4mple.com/", "https://hooks.example.com/\xc3\xa4",
          // Another scheme or port.
          "http://hooks.example.com/", "https://hooks.example.com:80/", "https://hooks.example.com:8443/",
          "https://hooks.example.com:/", "https://hooks.example.com:0443/", "https://hooks.example.com:99999/",
          "https://hooks.example.com:+443/", "https://hooks.example.com:443x/", "ftp://hooks.example.com/",
          "file:///etc/passwd", "gopher://hooks.example.com/", "javascript://hooks.example.com/",
          "//hooks.example.com/", "hooks.example.com", "https:hooks.example.com", "https:/hooks.example.com",
          "https:///hooks.example.com", "https://", "https://:443/", "", "https", "://hooks.example.com",
          "https://10.0.0.7:8080/", "http://10.0.0.7/", "http://10.7:8080/", "http://167772167:8080/",
          // Another path.
          "https://paths.example.com:8443/", "https://paths.example.com:8443/a", "https://paths.example.com:8443/a/bc",
          "https://paths.example.com:8443/a/b/../c", "https://paths.example.com:8443/a/b/%2e%2e/c",
          "https://paths.example.com:8443/a/b/.%2E/c", "https://paths.example.com:8443/a/b/./c",
          "https://paths.example.com:8443/a/b/..;x=1/c", "https://paths.example.com:8443/a/b/%2e%2e%3bx/c",
          "https://paths.example.com:8443/a/b/..", "https://paths.example.com:8443/a/b%2f..%2fc",
          "https://paths.example.com:8443/a/b/%252e%252e/c", "https://paths.example.com:8443/a/b/..%5cc",
          "https://paths.example.com:8443/a/b/%00", "https://paths.example.com:8443/a/b/%0a",
          "https://paths.example.com:8443//a/b", "https://paths.example.com:8443/a//b",
          "https://paths.example.com:8443/a/b//c", "https://paths.example.com:8443/A/b",
          "https://paths.example.com:8443/a/b/%", "https://paths.example.com:8443/a/b/%4",
          "https://paths.example.com:8443/a/b/%zz", "https://tail.example.com/in", "https://tail.example.com/inside",
          "https://hooks.example.com//evil.example/",
          // Another address.
          "https://[2001:db8::2]/", "https://[2001:db8::1%25eth0]/", "https://[2001:db8::1/",
          "https://[::ffff:10.0.0.7]/", "https://[2001:db8::1]evil.example/", "https://2001:db8::1/", "https://[]/",
          "https://[hooks.example.com]/"})
        EXPECT_FALSE(allows(url)) << url;
}

TEST(Targets, SayWhatIsWrong) {
    const auto fault = [](const char* url) {
        const auto read = parse_address(url);
        return std::holds_alternative<std::string>(read) ? std::get<std::string>(read) : "nothing";
    };
    EXPECT_THAT(fault("https://a@b/"), HasSubstr("no user before an @"));
    EXPECT_THAT(fault("https://a/#b"), HasSubstr("no fragment"));
    EXPECT_THAT(fault("https://a/../b"), HasSubstr("no segment . or .."));
    EXPECT_THAT(fault("https://a//b"), HasSubstr("no empty segment"));
    EXPECT_THAT(fault("https://a/b c"), HasSubstr("without blanks"));
    EXPECT_THAT(fault("ftp://a/"), HasSubstr("must be https"));
    EXPECT_THAT(fault("https://a:b/"), HasSubstr("its port"));
    EXPECT_THAT(fault("a.example"), HasSubstr("https://hooks.example.com/path"));
}

TEST(Targets, ShowNoMoreThanTheOrigin) {
    const auto address = std::get<WebAddress>(parse_address("http://A.example:8080/secret/path?token=x"));
    EXPECT_EQ(address.origin(), "http://a.example:8080");
    EXPECT_EQ(address.target(), "/secret/path?token=x");
    EXPECT_EQ(std::get<WebAddress>(parse_address("https://[0:0::1]/")).origin(), "https://[::1]");
    EXPECT_EQ(std::get<WebAddress>(parse_address("https://a.example:443?x")).target(), "/?x");
}

TEST(Targets, AreRefusedWhereTheyAreNone) {
    EXPECT_THROW(Targets({"hooks.example.com"}), std::invalid_argument);
    EXPECT_THROW(Targets({"https://hooks.example.com/?x"}), std::invalid_argument);
    EXPECT_THROW(Targets({"*"}), std::invalid_argument);
    EXPECT_THROW(Targets({""}), std::invalid_argument);
    EXPECT_TRUE(Targets({}).empty());
}

}  // namespace
}  // namespace tunewright::server
