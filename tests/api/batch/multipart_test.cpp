// Forms with files.
#include "api/batch/multipart.h"

#include <gmock/gmock.h>

namespace tunewright::api {
namespace {

/// The parts as "name|file|content;" and the problem, cut into pieces.
std::string parts_of(const std::string& body, std::size_t piece, const std::string& boundary = "B") {
    std::string out;
    Multipart parts(boundary, {[&](const std::string& name, const std::string& file) -> std::optional<Problem> {
                                   out += name + "|" + file + "|";
                                   return std::nullopt;
                               },
                               [&](std::string_view bytes) -> std::optional<Problem> {
                                   out += bytes;
                                   return std::nullopt;
                               },
                               [&]() -> std::optional<Problem> {
                                   out += ";";
                                   return std::nullopt;
                               }});
    std::optional<Problem> problem;
    for (std::size_t at = 0; at < body.size() && !problem; at += piece)
        problem = parts.feed(std::string_view(body).substr(at, piece));
    if (!problem) problem = parts.finish();
    return problem ? out + " " + std::to_string(problem->status) : out;
}

std::string part(const std::string& head, const std::string& content) {
    return "--B\r\nContent-Disposition: form-data; " + head + "\r\n\r\n" + content + "\r\n";
}

TEST(Multipart, HasItsPartsHoweverItIsCut) {
    const std::string body =
        "preamble\r\n" + part("name=\"loops\"", "tag,kind\r\nA,flow\r\n") +
        part("name=\"file\"; filename=\"C:\\day\\FIC 1;a.csv\"\r\nContent-Type: text/csv", "t,y\n--B\n1,2\r\n--") +
        part("filename=dir/x.csv; name=file", "") + "--B--\r\nepilogue";
    const std::string expected = "loops||tag,kind\r\nA,flow\r\n;file|FIC 1;a.csv|t,y\n--B\n1,2\r\n--;file|x.csv|;";
    for (const std::size_t piece : {1, 2, 3, 7, 1000}) EXPECT_EQ(parts_of(body, piece), expected) << piece;
}

TEST(Multipart, HasNamesInUtf8) {
    EXPECT_EQ(parts_of(part("name=\"file\"; filename=\"Durchfluss \xFC.csv\"", "") + "--B--", 100),
              "file|Durchfluss \xC3\xBC.csv|;");
}

TEST(Multipart, RefusesWhatIsNone) {
    EXPECT_EQ(parts_of("", 10), " 400");
    EXPECT_EQ(parts_of("t,y\n1,2\n", 10), " 400");
    EXPECT_EQ(parts_of(part("name=\"a\"", "x"), 10), "a|| 400") << "the last boundary is missing";
    EXPECT_EQ(parts_of(part("filename=\"a\"", "x") + "--B--", 10), " 400") << "a part without a name";
    EXPECT_EQ(parts_of("--B\r\nX: " + std::string(9000, 'x'), 100), " 400");
}

TEST(Multipart, FindsTheBoundary) {
    EXPECT_EQ(boundary_of("multipart/form-data; boundary=abc"), "abc");
    EXPECT_EQ(boundary_of("multipart/form-data; charset=utf-8; Boundary=\"a b;c\""), "a b;c");
    EXPECT_EQ(boundary_of("multipart/form-data"), "");
    EXPECT_EQ(boundary_of("multipart/form-data; boundary"), "");
}

}  // namespace
}  // namespace tunewright::api
