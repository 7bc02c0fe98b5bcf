// The table with what is known of loops.
#include "api/batch/known_loops.h"

#include <gmock/gmock.h>

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

KnownLoops read_table(const std::string& text, const std::string& unit = "s") {
    auto read = KnownLoops::read(text, unit);
    const auto* problem = std::get_if<Problem>(&read);
    EXPECT_EQ(problem, nullptr) << problem->detail;
    return problem == nullptr ? std::get<KnownLoops>(std::move(read)) : KnownLoops();
}

std::vector<std::string> faults_of(const std::string& text) {
    const auto read = KnownLoops::read(text, "s");
    std::vector<std::string> out;
    if (const auto* problem = std::get_if<Problem>(&read))
        for (const FieldError& error : problem->errors) out.push_back(error.detail);
    return out;
}

TEST(KnownLoops, HaveTheMembersOfALoop) {
    KnownLoops loops = read_table(
        "Tag,kind,averaging,pv_low,pv_high,op_low,op_high,Kp,Ti,Td,weight\n"
        "FIC101,flow,,0,120,0,100,0.8,20,,2.5\n"
        "LIC7,Level,yes,,,,,,,,\n");
    const KnownLoop* flow = loops.of("fic101");
    ASSERT_NE(flow, nullptr);
    EXPECT_EQ(flow->members, Json::parse(R"({"kind": "flow", "range": {"pv": [0, 120], "op": [0, 100]}, "weight": 2.5,
        "controller": {"Kp": 0.8, "Ti": 20, "form": "ideal"}})"));
    EXPECT_EQ(flow->facts.kind, check::LoopKind::flow);
    EXPECT_EQ((*flow->facts.range.pv)[1], 120);
    EXPECT_EQ(flow->facts.weight, 2.5);
    ASSERT_TRUE(flow->facts.controller);
    const KnownLoop* level = loops.of("LIC7");
    ASSERT_NE(level, nullptr);
    EXPECT_EQ(level->members, Json({{"kind", "level"}, {"averaging", true}}));
    EXPECT_EQ(level->facts.averaging, true);
    EXPECT_FALSE(level->facts.controller || level->facts.range.pv);
    EXPECT_EQ(loops.of("FIC102"), nullptr);
}

TEST(KnownLoops, AreReadAsExportedBySpreadsheets) {
    KnownLoops loops = read_table("\xEF\xBB\xBFweight;tag;Kp;Ti [min]\r\n1,5;FIC101;0,8;2\r\n\r\n", "s");
    EXPECT_EQ(loops.of("FIC101")->members, Json::parse(R"({"weight": 1.5, "controller": {"Kp": 0.8, "Ti": 120,
        "form": "ideal"}})"));
    EXPECT_EQ(read_table("tag,Kp,Ti [min]\nA,1,2\n", "min").of("A")->members.at("controller").at("Ti"), 2);
}

TEST(KnownLoops, ABadValueNamesItsLineAndColumn) {
    const auto faults = faults_of(
        "tag,kind,averaging,pv_low,pv_high,op_low,op_high,Ti,weight\n"
        "A,flw,,,,,,,\n"
        "B,,maybe,,,,,,\n"
        "C,,,ten,20,,,,\n"
        "D,,,,,100,0,,\n"
        "E,,,5,,,,,-1\n"
        "F,,,,,,,soon,\n"
        ",flow,,,,,,,\n"
        "G,flow,,,,,,,\n"
        "g,flow,,,,,,,\n");
    ASSERT_THAT(faults, SizeIs(8));
    EXPECT_THAT(faults[0], HasSubstr("Line 2, kind: kind is \"flw\""));
    EXPECT_EQ(faults[1], "Line 3, averaging: \"maybe\" must be true or false.");
    EXPECT_EQ(faults[2], "Line 4, pv_low: \"ten\" is not a number.");
    EXPECT_THAT(faults[3], HasSubstr("Line 5, op_low and op_high: op is [100,0]"));
    EXPECT_EQ(faults[4], "Line 6, pv_low and pv_high: a range needs both ends.");
    EXPECT_EQ(faults[5], "Line 7, Ti is \"soon\"; it must be a number, or empty.");
    EXPECT_EQ(faults[6], "Line 8 has no tag.");
    EXPECT_EQ(faults[7], "g is in two lines. Remove one of them.");
}

TEST(KnownLoops, ATableThatIsNoneIsRefused) {
    EXPECT_THAT(faults_of("").at(0), HasSubstr("The table has no loop."));
    EXPECT_THAT(faults_of("tag,kind\n").at(0), HasSubstr("The table has no loop."));
    EXPECT_THAT(faults_of("kind\nflow\n").at(0), HasSubstr("no column tag"));
    EXPECT_THAT(faults_of("tag,sort\nA,flow\n").at(0), HasSubstr("Line 1, sort: this column is not known."));
    EXPECT_THAT(faults_of("tag,product\nA,x\n").at(0), HasSubstr("not known"));
    EXPECT_THAT(faults_of("tag,Ti [furlong]\nA,1\n").at(0), HasSubstr("\"furlong\" is not a unit of time"));
    EXPECT_THAT(faults_of("tag,kind\nA,flow,3\n").at(0), HasSubstr("Line 2 has more cells than headings."));
}

TEST(KnownLoops, TagsWithoutARecordAreNamed) {
    KnownLoops loops = read_table("tag,kind\nA,flow\nB,flow\nC,flow\n");
    loops.of("B");
    EXPECT_EQ(loops.unused_note(), "A and C are in the table of loops, but no record has these tags.");
    loops.of("a");
    EXPECT_EQ(loops.unused_note(), "C is in the table of loops, but no record has this tag.");
    loops.of("C");
    EXPECT_EQ(loops.unused_note(), "");
}

}  // namespace
}  // namespace tunewright::api
