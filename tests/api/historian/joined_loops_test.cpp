// Loops of several files.
#include "api/historian/joined_loops.h"

#include <gmock/gmock.h>

#include "tests/api/historian/recorded_plant.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void add_file(JoinedLoops& loops, const std::string& name, const std::string& text) {
    LoopsReader reader({});
    std::size_t at = 0;
    for (int number = 1; const auto line = next_line(text, at); ++number) ASSERT_FALSE(reader.line(number, *line));
    const auto problem = reader.finish();
    ASSERT_FALSE(problem) << problem->detail;
    loops.add(name, reader);
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
    const std::vector<TaggedLoop> expected = whole.take();
    ASSERT_EQ(expected.size(), 3u);
    EXPECT_EQ(expected[0].tag, "FIC101");
    EXPECT_EQ(shown_all(overlapping.take()), shown_all(expected));
    EXPECT_EQ(shown_all(parts.take()), shown_all(expected));
}

TEST(JoinedLoops, NeedDates) {
    const std::string undated = "t,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n0,1,2,3,4\n1,2,3,4,5\n2,3,4,5,6\n";
    std::string other = undated;
    other.replace(other.find("FIC2.PV"), 4, "FIC3").replace(other.find("FIC2.OP"), 4, "FIC3");
    JoinedLoops loops(1);
    add_file(loops, "a.csv", undated);
    add_file(loops, "b.csv", other);
    const std::vector<TaggedLoop> out = loops.take();
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
        const std::vector<TaggedLoop> out = loops.take();
        ASSERT_EQ(out.size(), 1u);
        EXPECT_FALSE(out[0].fault);
        EXPECT_EQ(out[0].t.size(), 3u);
        EXPECT_THAT(out[0].notes,
                    ElementsAre(HasSubstr("bad.csv was left out: FIC1.PV has no value of good quality.")));
    }
}

}  // namespace
}  // namespace tunewright::api
