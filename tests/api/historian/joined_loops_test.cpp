// Loops of several files.
#include "api/historian/joined_loops.h"

#include <gmock/gmock.h>

#include "tests/api/historian/recorded_plant.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void add_file(JoinedLoops& loops, const std::string& name, const std::string& text) {
    LoopsOptions options;
    options.set_file(name);
    LoopsReader reader(options);
    std::size_t at = 0;
    for (int number = 1; const auto line = next_line(text, at); ++number) ASSERT_FALSE(reader.line(number, *line));
    const auto problem = reader.finish();
    ASSERT_FALSE(problem) << problem->detail;
    loops.add(name, reader);
}

std::vector<TaggedLoop> all_taken(JoinedLoops& loops) {
    const auto problem = loops.finish();
    EXPECT_FALSE(problem) << problem->detail;
    std::vector<TaggedLoop> out;
    for (TaggedLoop loop; loops.next(loop);) out.push_back(loop);
    return out;
}

/// The lines [from, to) of the file of three loops, with its headings.
std::string part_of_file(int from, int to) {
    const std::string whole = recorded::wide_file();
    std::string out;
    std::size_t at = 0;
    for (int row = -1; const auto line = next_line(whole, at); ++row)
        if (row < 0 || (row >= from && row < to)) out += std::string(*line) + "\n";
    return out;
}

std::string shown_all(const std::vector<TaggedLoop>& loops) {
    std::string out;
    for (const TaggedLoop& loop : loops) out += recorded::all_of(loop);
    return out;
}

TEST(JoinedLoops, ArePartsOfOneLoopByTheirDates) {
    JoinedLoops whole(1), parts(1), overlapping(1);
    add_file(whole, "day.csv", recorded::wide_file());
    add_file(parts, "afternoon.csv", part_of_file(35, recorded::kRows));
    add_file(parts, "morning.csv", part_of_file(0, 35));
    add_file(overlapping, "morning.csv", part_of_file(0, 40));
    add_file(overlapping, "afternoon.csv", part_of_file(30, recorded::kRows));
    const std::vector<TaggedLoop> expected = all_taken(whole);
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_EQ(expected[0].tag, "FIC101");
    EXPECT_EQ(shown_all(all_taken(overlapping)), shown_all(expected));
    EXPECT_EQ(shown_all(all_taken(parts)), shown_all(expected));
}

TEST(JoinedLoops, NeedDates) {
    const std::string undated = "t,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n0,1,2,3,4\n1,2,3,4,5\n2,3,4,5,6\n";
    std::string other = undated;
    other.replace(other.find("FIC2.PV"), 4, "FIC3").replace(other.find("FIC2.OP"), 4, "FIC3");
    JoinedLoops loops(1);
    add_file(loops, "a.csv", undated);
    add_file(loops, "b.csv", other);
    const std::vector<TaggedLoop> out = all_taken(loops);
    ASSERT_EQ(out.size(), 3u);
    EXPECT_EQ(out[0].fault,
              "FIC1 is in a.csv and in b.csv, and without dates in both the order is not known. Export with dates, or "
              "rename the tag in one of them.");
    EXPECT_FALSE(out[1].fault || out[2].fault);
}

TEST(JoinedLoops, APartThatCannotBeReadIsLeftOut) {
    const std::string good =
        "Time,FIC1.PV,FIC1.OP\n2026-05-04 06:00:00,1.5,2\n2026-05-04 06:01:00,2,3\n"
        "2026-05-04 06:02:00,3,4\n";
    std::string bad =
        "Time,FIC1.PV,FIC1.OP\n2026-05-05 06:00:00,Bad,2\n2026-05-05 06:01:00,Bad,3\n"
        "2026-05-05 06:02:00,Bad,4\n";
    for (const bool good_first : {true, false}) {
        JoinedLoops loops(1);
        add_file(loops, good_first ? "good.csv" : "bad.csv", good_first ? good : bad);
        add_file(loops, good_first ? "bad.csv" : "good.csv", good_first ? bad : good);
        const std::vector<TaggedLoop> out = all_taken(loops);
        ASSERT_EQ(out.size(), 1u);
        EXPECT_FALSE(out[0].fault);
        EXPECT_EQ(out[0].t.size(), 3u);
        EXPECT_THAT(out[0].notes,
                    ElementsAre(HasSubstr("bad.csv was left out: FIC1.PV has no value of good quality.")));
    }
}

TEST(JoinedLoops, SayThatPartsWereJoined) {
    JoinedLoops parts(1);
    add_file(parts, "morning.csv", part_of_file(0, 35));
    add_file(parts, "afternoon.csv", part_of_file(35, recorded::kRows));
    EXPECT_THAT(all_taken(parts)[0].notes, ElementsAre("Its parts in 2 files were joined by their dates."));
}

TEST(JoinedLoops, AnOnlyFileThatCannotBeReadIsRefused) {
    JoinedLoops one(1), two(1);
    one.add_unreadable("a.csv", unreadable_loops("It is empty."));
    EXPECT_EQ(one.finish()->status, 422);
    two.add_unreadable("a.csv", unreadable_loops("It is empty."));
    add_file(two, "b.csv", recorded::wide_file());
    const std::vector<TaggedLoop> out = all_taken(two);
    ASSERT_EQ(out.size(), 4u);
    EXPECT_EQ(out[0].tag + ": " + out[0].fault.value_or(""), "a.csv: It is empty.");
    EXPECT_TRUE(JoinedLoops(1).finish().has_value()) << "no file at all";
}

/// The file of one tag of the three loops: time and value, under a heading or without one.
std::string tag_file(std::size_t loop, const std::string& part, bool headed, int from = 0, int to = recorded::kRows) {
    std::string out = headed ? "Timestamp;Value;Quality\n" : "";
    for (int row = from; row < to; ++row)
        out += recorded::stamp_at(row) + ";" + recorded::value_at(loop, part, row) + (headed ? ";Good" : "") + "\n";
    return out;
}

TEST(JoinedLoops, ArePutTogetherFromAFileForEachTag) {
    JoinedLoops whole(1), tags(1);
    add_file(whole, "day.csv", recorded::wide_file());
    for (std::size_t loop = 0; loop < recorded::kTags.size(); ++loop)
        for (const std::string& part : recorded::kParts)
            add_file(tags, "export/" + recorded::kTags[loop] + "." + part + ".csv", tag_file(loop, part, loop != 1));
    const std::vector<TaggedLoop> out = all_taken(tags);
    EXPECT_EQ(shown_all(out), shown_all(all_taken(whole)));
    EXPECT_THAT(out[0].notes, ElementsAre("The tags FIC101.OP, FIC101.PV, FIC101.SP and FIC101.MODE were put together; "
                                          "each has a file of its own."));
    EXPECT_THAT(tags.notes(), testing::IsEmpty());
}

TEST(JoinedLoops, OfOneTagMayBeginAtOtherTimesAndComeInParts) {
    JoinedLoops whole(1), tags(1);
    add_file(whole, "day.csv", recorded::wide_file());
    add_file(tags, "FIC101.OP.csv", tag_file(0, "OP", true));
    add_file(tags, "b/FIC101.PV.csv", tag_file(0, "PV", true, 20));
    add_file(tags, "a/FIC101.PV.csv", tag_file(0, "PV", false, 10, 25));
    const std::vector<TaggedLoop> out = all_taken(tags);
    ASSERT_EQ(out.size(), 1u);
    const TaggedLoop expected = all_taken(whole)[0];
    ASSERT_EQ(out[0].t.size(), expected.t.size() - 10);
    for (std::size_t i = 0; i < out[0].t.size(); ++i) {
        EXPECT_EQ(out[0].t[i] + *out[0].epoch, expected.t[i + 10] + *expected.epoch);
        EXPECT_EQ(out[0].y[i], expected.y[i + 10]);
        EXPECT_EQ(out[0].u[i], expected.u[i + 10]);
    }
}

TEST(JoinedLoops, ATagWithoutTheOtherPartIsNamed) {
    JoinedLoops tags(1), alone(1), headed(1);
    add_file(tags, "FIC1.PV.csv", tag_file(0, "PV", true));
    add_file(tags, "FIC1.OP.csv", tag_file(0, "OP", true));
    add_file(tags, "TI103.PV.csv", tag_file(1, "PV", true));
    EXPECT_EQ(all_taken(tags).size(), 1u);
    EXPECT_THAT(tags.notes(),
                ElementsAre("TI103 has only a measurement or only a controller output and is not checked."));
    add_file(alone, "TI103.PV.csv", tag_file(1, "PV", true));
    EXPECT_TRUE(alone.finish().has_value()) << "no loop at all";
    // The heading of the value names the tag better than the file.
    add_file(headed, "1.csv", "Time,FIC7.PV\n0,1\n1,2\n2,3.5\n");
    add_file(headed, "2.csv", "Time,FIC7.OP\n0,5\n1,6\n2,7.5\n");
    const std::vector<TaggedLoop> out = all_taken(headed);
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].tag, "FIC7");
    EXPECT_THAT(out[0].u, ElementsAre(5, 6, 7.5));
}

TEST(JoinedLoops, TagsWithAndWithoutDatesAreNotCompared) {
    JoinedLoops tags(1);
    add_file(tags, "FIC1.PV.csv", tag_file(0, "PV", true));
    add_file(tags, "FIC1.OP.csv", "Time,Value\n0,5\n1,6\n2,7.5\n");
    const std::vector<TaggedLoop> out = all_taken(tags);
    ASSERT_EQ(out.size(), 1u);
    EXPECT_THAT(out[0].fault.value_or(""), HasSubstr("has dates, so their times cannot be compared."));
}

}  // namespace
}  // namespace tunewright::api
