// Tags of control systems as loops and their parts.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "api/historian/tags/loop_tags.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct SplitCase {
    const char* tag;
    std::optional<ColumnRole> role;
    const char* loop;
};

TEST(LoopTags, AreSplitInTheWaysOfControlSystems) {
    for (const auto& [tag, role, loop] : {SplitCase{"FIC101.PV", kOutputRole, "FIC101"},
                                          {"FIC101.SP", kReferenceRole, "FIC101"},
                                          {"FIC101.OP", kInputRole, "FIC101"},
                                          {"FIC101.MODE", kModeRole, "FIC101"},
                                          {"FIC-101_PV", kOutputRole, "FIC-101"},
                                          {"TIC-101.MODE", kModeRole, "TIC-101"},
                                          {"101FIC.PIDA.PV", kOutputRole, "101FIC.PIDA"},
                                          {"101FIC.PIDA.OP", kInputRole, "101FIC.PIDA"},
                                          {"101FIC.PIDA.MODE", kModeRole, "101FIC.PIDA"},
                                          {"TIC-101/PID1/OUT.CV", kInputRole, "TIC-101/PID1"},
                                          {"TIC-101/PID1/PV.CV", kOutputRole, "TIC-101/PID1"},
                                          {"TIC-101/PID1/SP.CV", kReferenceRole, "TIC-101/PID1"},
                                          {"TIC-101/PID1/MODE.ACTUAL", kModeRole, "TIC-101/PID1"},
                                          {"TIC-101/PID1/MODE.TARGET", {}, ""},
                                          {"Unit 7 FIC101.SP", kReferenceRole, "Unit 7 FIC101"},
                                          {"Pump 3 FIC101.PV", kOutputRole, "Pump 3 FIC101"},
                                          {"Reactor level LIC7.OP", kInputRole, "Reactor level LIC7"},
                                          {"FIC101.PV [m3/h]", kOutputRole, "FIC101"},
                                          {"FIC101.OP (%)", kInputRole, "FIC101"},
                                          {"FIC101 PV", kOutputRole, "FIC101"},
                                          {"FIC101PV", kOutputRole, "FIC101"},
                                          {"FIC101OP", kInputRole, "FIC101"},
                                          {"PV_FIC101", kOutputRole, "FIC101"},
                                          {"SP_FIC101", kReferenceRole, "FIC101"},
                                          {"OP.FIC101", kInputRole, "FIC101"},
                                          {"FIC101.MV", kInputRole, "FIC101"},
                                          {"FIC101.SV", kReferenceRole, "FIC101"},
                                          {"FIC101.LMN", kInputRole, "FIC101"},
                                          {"FIC101.PV_IN", kOutputRole, "FIC101"},
                                          {"FIC101.PV_Out", kOutputRole, "FIC101"},
                                          {"FIC101.MV.Value", kInputRole, "FIC101"},
                                          {"Temp.PV", kOutputRole, "Temp"},
                                          {"Temp.CV", kInputRole, "Temp"},
                                          {"Valve12.PV", kOutputRole, "Valve12"},
                                          {"FIC101 set point", kReferenceRole, "FIC101"},
                                          {"FIC101 process value", kOutputRole, "FIC101"},
                                          {"[PLC1]FIC101.PV", kOutputRole, "[PLC1]FIC101"},
                                          {"loop1.y", kOutputRole, "loop1"},
                                          {"loop1.u", kInputRole, "loop1"},
                                          {"PV", kOutputRole, ""},
                                          {"SP", kReferenceRole, ""},
                                          {"MODE", kModeRole, ""},
                                          {"PV2", kOutputRole, "Loop 2"},
                                          {"OP2", kInputRole, "Loop 2"},
                                          {"FIC101.ALARM", {}, ""},
                                          {"FIC101.SP_HI", {}, ""},
                                          {"FIC101.ERR", {}, ""},
                                          {"Comment", {}, ""}}) {
        const TagName name = split_tag(tag);
        EXPECT_EQ(name.role, role) << tag;
        EXPECT_FALSE(name.quality) << tag;
        EXPECT_EQ(role ? name.loop : "", loop) << tag;
    }
}

TEST(LoopTags, KnowQualities) {
    for (const char* tag : {"FIC101.PV.Quality", "FIC101.PV_Status", "FIC101.PV - Quality", "FIC101PV.QUAL"}) {
        EXPECT_TRUE(split_tag(tag).quality) << tag;
        EXPECT_EQ(split_tag(tag).role, kOutputRole) << tag;
        EXPECT_EQ(split_tag(tag).key, split_tag("FIC101.OP").key) << tag;
    }
    const auto groups =
        group_tags({"Time", "FIC1.PV", "Quality", "FIC1.OP", "Quality", "FIC2.OP", "FIC2.PV", "FIC2.PV.Status"});
    ASSERT_EQ(groups.loops.size(), 2u);
    EXPECT_EQ(groups.loops[0].y_quality, 2u);
    EXPECT_EQ(groups.loops[0].u_quality, 4u);
    EXPECT_EQ(groups.loops[1].y_quality, 7u);
    EXPECT_EQ(groups.loops[1].u_quality, std::nullopt);
}

std::string shown_groups(const std::vector<std::string>& tags, const GroupedTags& groups) {
    std::vector<std::string> lines;
    for (const LoopTags& loop : groups.loops) {
        std::string line = loop.name + ":";
        for (const auto& at : loop.at) line += " " + (at ? tags[*at] : "-");
        lines.push_back(line);
    }
    std::ranges::sort(lines);
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

TEST(LoopTags, GroupInAnyOrder) {
    std::vector<std::string> tags = {"Time", "Comment"};
    for (const char* loop : {"FIC101", "TIC-101/PID1", "Unit 7 LIC3", "101FIC.PIDA"})
        for (const char* part : {".PV", ".SP", ".OP", ".MODE", ".ALARM"}) tags.push_back(loop + std::string(part));
    const std::string expected = shown_groups(tags, group_tags(tags));
    EXPECT_THAT(expected, HasSubstr("FIC101: - FIC101.OP FIC101.PV FIC101.SP FIC101.MODE\n"));
    EXPECT_EQ(std::ranges::count(expected, '\n'), 4);
    std::mt19937 chance(5);
    for (int k = 0; k < 20; ++k) {
        std::ranges::shuffle(tags, chance);
        EXPECT_EQ(shown_groups(tags, group_tags(tags)), expected);
    }
}

TEST(LoopTags, GroupWithoutRegardToLetterCase) {
    const auto groups = group_tags({"fic101.pv", "FIC101.OP"});
    ASSERT_EQ(groups.loops.size(), 1u);
    EXPECT_EQ(groups.loops[0].name, "fic101");
}

TEST(LoopTags, AreAmbiguousOnlyInTheirOwnLoop) {
    const auto groups = group_tags({"FIC1.PV", "FIC1.pv", "FIC1.OP", "FIC2.PV", "FIC2.OP"});
    ASSERT_EQ(groups.loops.size(), 2u);
    EXPECT_EQ(groups.loops[0].fault,
              "\"FIC1.PV\" and \"FIC1.pv\" may both be the measurement. Remove or rename one of them.");
    EXPECT_EQ(groups.loops[1].fault, "");
    // The usual name of a part comes before others.
    const auto two = group_tags({"FIC1.Value", "FIC1.PV", "FIC1.OUT", "FIC1.OP", "FIC1.RSP", "FIC1.SP"});
    ASSERT_EQ(two.loops.size(), 1u);
    EXPECT_EQ(two.loops[0].fault, "");
    EXPECT_THAT(two.loops[0].at, ElementsAre(std::nullopt, 3u, 1u, 5u, std::nullopt));
}

TEST(LoopTags, SayWhatTheLoopMeasures) {
    for (const auto& [tag, kind] : {std::pair{"FIC101", "flow"},
                                    {"TIC-101/PID1", "temperature"},
                                    {"2111FIC41004", "flow"},
                                    {"U7.LC3", "level"},
                                    {"PDIC9", "pressure"},
                                    {"FFC2", "flow"},
                                    {"AICA7", "composition"},
                                    {"TI101", ""},
                                    {"Loop 1", ""},
                                    {"Tank C", ""},
                                    {"XFIC", ""},
                                    {"HIC4", ""},
                                    {"", ""}})
        EXPECT_EQ(kind_of_tag(tag).name, kind) << tag;
}

TEST(LoopTags, NameWhatIsNoLoop) {
    const auto groups = group_tags({"TI5.PV", "FIC1.PV", "FIC1.OP", "HIC9.OP", "XA3.ALARM"});
    EXPECT_THAT(groups.partial, ElementsAre("TI5", "HIC9"));
    EXPECT_EQ(partial_note(groups.partial),
              "TI5 and HIC9 have only a measurement or only a controller output and are not checked.");
    EXPECT_THAT(partial_note({"a", "b", "c", "d", "e", "f", "g"}), HasSubstr("a, b, c, d, e and 2 more have only"));
    EXPECT_THAT(partial_note({}), IsEmpty());
}

}  // namespace
}  // namespace tunewright::api
