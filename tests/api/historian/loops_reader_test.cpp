// Files of many loops in the layouts of historians.
#include "api/historian/loops_reader.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "tests/api/historian/recorded_plant.h"

namespace tunewright::api {
namespace {

using recorded::all_of;
using recorded::kParts;
using recorded::kRows;
using recorded::kStep;
using recorded::kTags;
using recorded::loop_of;
using recorded::read_file;
using recorded::ReadFile;
using recorded::stamp_at;
using recorded::value_at;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::string joined_lines(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

void replace_all(std::string& text, const std::string& old, const std::string& fresh) {
    for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += fresh.size())
        text.replace(at, old.size(), fresh);
}

TEST(LoopsReader, ReadsLoopsInColumns) {
    const ReadFile file = read_file(recorded::wide_file());
    ASSERT_EQ(file.refusal, "");
    ASSERT_EQ(file.loops.size(), kTags.size());
    const TaggedLoop& loop = loop_of(file, "TIC-102");
    ASSERT_EQ(loop.t.size(), static_cast<std::size_t>(kRows));
    EXPECT_EQ(loop.epoch, 1777874400);
    EXPECT_FALSE(loop.utc);
    EXPECT_THAT(loop.notes, IsEmpty());
    for (int row = 0; row < kRows; ++row) {
        const auto i = static_cast<std::size_t>(row);
        EXPECT_EQ(loop.t[i], row * kStep);
        EXPECT_EQ(loop.y[i], std::stod(value_at(1, "PV", row)));
        EXPECT_EQ(loop.u[i], std::stod(value_at(1, "OP", row)));
        EXPECT_EQ(loop.r[i], std::stod(value_at(1, "SP", row)));
        EXPECT_EQ(loop.mode_words[loop.mode[i]], value_at(1, "MODE", row));
    }
}

TEST(LoopsReader, GivesTheSameLoopsFromEachLayout) {
    const std::string wide = all_of(read_file(recorded::wide_file()));
    EXPECT_EQ(all_of(read_file(recorded::long_file())), wide);
    EXPECT_EQ(all_of(read_file(recorded::rows_file())), wide);
}

TEST(LoopsReader, ReadsALongFileInAnyOrder) {
    const auto sorted_shown = [](ReadFile file) {
        std::ranges::sort(file.loops, {}, &TaggedLoop::tag);
        return all_of(file);
    };
    const std::string expected = sorted_shown(read_file(recorded::long_file()));
    std::vector<std::string> lines = lines_of(recorded::long_file());
    const auto rows = lines.begin() + 1;
    std::ranges::stable_sort(rows, lines.end(), {}, [](const std::string& line) { return line.substr(20); });
    EXPECT_EQ(sorted_shown(read_file(joined_lines(lines))), expected) << "tag by tag";
    std::reverse(rows, lines.end());
    EXPECT_EQ(sorted_shown(read_file(joined_lines(lines))), expected) << "newest first";
    std::mt19937 chance(3);
    std::shuffle(rows, lines.end(), chance);
    EXPECT_EQ(sorted_shown(read_file(joined_lines(lines))), expected) << "shuffled";
}

// The first lines of such a file are all of one tag, and may hold no number.
TEST(LoopsReader, ReadsAFileThatBeginsWithThousandsOfWords) {
    constexpr int kMany = 6000;
    for (const bool two_columns : {false, true}) {
        std::string text = two_columns ? "Tag,Parameter,Time,Value\n" : "Tag,Time,Value\n";
        for (const char* part : {"DESC", "MODE", "OP", "PV"})
            for (int k = 0; k < kMany; ++k) {
                const std::string value = *part == 'D'   ? "Feed flow"
                                          : *part == 'M' ? "AUTO"
                                                         : std::to_string(k % 50) + ".5";
                text += std::string("FIC1") + (two_columns ? "," : ".") + part + "," + std::to_string(k) + "," + value +
                        "\n";
            }
        const ReadFile file = read_file(text);
        ASSERT_EQ(file.loops.size(), 1u) << file.refusal;
        EXPECT_EQ(file.loops[0].tag, "FIC1");
        EXPECT_EQ(file.loops[0].t.size(), static_cast<std::size_t>(kMany));
        EXPECT_EQ(file.loops[0].mode_words.at(file.loops[0].mode.at(0)), "AUTO");
    }
}

TEST(LoopsReader, FindsTheColumnsThatNameALoop) {
    const auto tags_of = [](const std::string& headings, const std::vector<std::string>& cells) {
        std::string text = "Time," + headings + ",Value\n";
        for (const char* loop : {"FIC1", "FIC2"})
            for (const char* part : {"PV", "OP"})
                for (int k = 0; k < 300; ++k) {
                    text += std::to_string(k);
                    for (const std::string& cell : cells)
                        text += "," + (cell == "loop"   ? loop
                                       : cell == "part" ? part
                                       : cell == "tag"  ? std::string(loop) + "." + part
                                                        : cell);
                    text += "," + std::to_string(k % 40) + ".5\n";
                }
        std::vector<std::string> out;
        for (const TaggedLoop& loop : read_file(text).loops) out.push_back(loop.tag);
        return out;
    };
    EXPECT_THAT(tags_of("Tag", {"tag"}), ElementsAre("FIC1", "FIC2"));
    EXPECT_THAT(tags_of("Tag,Parameter", {"loop", "part"}), ElementsAre("FIC1", "FIC2"));
    EXPECT_THAT(tags_of("Tag,Name", {"tag", "Feed flow"}), ElementsAre("FIC1", "FIC2"));
    EXPECT_THAT(tags_of("Name,Tag", {"Feed flow", "tag"}), ElementsAre("FIC1", "FIC2"));
    EXPECT_THAT(tags_of("Tag,Parameter,Name", {"loop", "part", "Feed flow"}), ElementsAre("FIC1", "FIC2"));
}

// A file that holds the tags one after the other sets the clock back by the hour that it covers: no summer time ends.
TEST(LoopsReader, AnHourForEachTagIsNoEndOfSummerTime) {
    std::string text = "Time,Tag,Value\n";
    for (const char* tag : {"FIC1.PV", "FIC1.OP"})
        for (int minute = 0; minute < 60; ++minute)
            text += "2026-10-25 02:" + std::string(minute < 10 ? "0" : "") + std::to_string(minute) + ":00," + tag +
                    "," + std::to_string(minute) + "\n";
    const TaggedLoop loop = loop_of(read_file(text), "FIC1");
    ASSERT_EQ(loop.t.size(), 60u);
    EXPECT_EQ(loop.t.back(), 3540);
    EXPECT_EQ(loop.u, loop.y);
}

TEST(LoopsReader, ReadsOtherSeparatorsSignsAndEncodings) {
    const std::string expected = all_of(read_file(recorded::wide_file()));
    std::string text = recorded::wide_file();
    std::ranges::replace(text, ',', ';');
    replace_all(text, ".5", ",5");
    for (int digit = 0; digit < 10; ++digit)
        replace_all(text, "." + std::to_string(digit) + "5", "," + std::to_string(digit) + "5");
    EXPECT_EQ(all_of(read_file(text)), expected) << "decimal commas";
    std::string windows = recorded::wide_file();
    replace_all(windows, "FIC101.PV,", "FIC101.PV [\xB0\x43],");
    EXPECT_EQ(all_of(read_file(windows)), expected) << "Windows-1252";
    std::string wide_text = "\xFF\xFE";
    for (const char c : recorded::wide_file()) wide_text += std::string{c, '\0'};
    EXPECT_EQ(all_of(read_file(wide_text)), expected) << "UTF-16";
    std::string crlf = recorded::wide_file();
    replace_all(crlf, "\n", "\r\n");
    EXPECT_EQ(all_of(read_file("# exported by a historian\r\n\r\n" + crlf)), expected) << "a comment above";
}

TEST(LoopsReader, ABrokenLoopDoesNotStopTheOthers) {
    const auto broken = [](const std::string& pv) {
        std::string text = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
        for (int k = 0; k < 30; ++k) {
            const std::string n = std::to_string(k);
            text += n + "," + pv + "," + n + "," + n + ".5," + n + "\n";
        }
        return read_file(text);
    };
    for (const char* pv : {"", "Bad", "####", "no signal"}) {
        const ReadFile file = broken(pv);
        ASSERT_EQ(file.loops.size(), 2u) << pv << file.refusal;
        EXPECT_THAT(file.loops[0].fault.value_or(""), HasSubstr("FIC1.PV has no ")) << pv;
        EXPECT_THAT(file.loops[0].t, IsEmpty());
        EXPECT_EQ(file.loops[1].fault, std::nullopt);
        EXPECT_EQ(file.loops[1].y.size(), 30u);
    }
    EXPECT_THAT(*broken("Bad").loops[0].fault, HasSubstr("no value of good quality"));
    EXPECT_EQ(broken("Bad").loops[0].bad, 30);
    EXPECT_THAT(broken("####").loops[0].notes,
                ElementsAre("30 values of \"FIC1.PV\" are not numbers, such as \"####\"; they count as missing."));
}

TEST(LoopsReader, KeepsGapsAndStairs) {
    std::string text = "Time,FIC1.PV,FIC1.OP\n";
    for (int k = 0; k < 40; ++k) {
        if (k >= 10 && k < 20) continue;
        const std::string pv = k == 25 ? "" : std::to_string(k / 8);
        text += std::to_string(k * 5) + "," + pv + "," + (k == 26 ? "" : std::to_string(k)) + "\n";
    }
    const TaggedLoop loop = loop_of(read_file(text), "FIC1");
    ASSERT_EQ(loop.t.size(), 30u);
    EXPECT_EQ(loop.t[10] - loop.t[9], 55);
    EXPECT_EQ(loop.y[3], loop.y[4]);
    EXPECT_TRUE(std::isnan(loop.y[15]) && loop.u[15] == 25);
    EXPECT_TRUE(std::isnan(loop.u[16]) && loop.y[16] == 3);
    EXPECT_EQ(loop.bad, 0);
}

/// Ten rows of two loops; PV of the first has these qualities.
ReadFile with_quality(const std::vector<std::string>& qualities) {
    std::string text = "Time,FIC1.PV,FIC1.PV.Quality,FIC1.OP,FIC2.PV,FIC2.OP\n";
    for (std::size_t k = 0; k < qualities.size(); ++k) {
        const std::string n = std::to_string(k);
        text += n + "," + n + ".5," + qualities[k] + "," + n + "," + n + "," + n + "\n";
    }
    return read_file(text);
}

TEST(LoopsReader, BadQualityIsAMissingValue) {
    const auto bad_rows = [](const std::vector<std::string>& qualities) {
        const ReadFile file = with_quality(qualities);
        const TaggedLoop& loop = loop_of(file, "FIC1");
        std::string out;
        for (const double y : loop.y) out += std::isnan(y) ? 'x' : '.';
        EXPECT_EQ(loop.bad, std::ranges::count(out, 'x'));
        return out;
    };
    EXPECT_EQ(bad_rows({"Good", "Good", "Bad", "Bad [Comm Failure]", "UNCERTAIN", "Questionable", "", "Good"}),
              "..xxxx..");
    EXPECT_EQ(bad_rows({"192", "192", "0", "24", "64", "216", "255", "192"}), "..xxx...") << "OPC DA";
    EXPECT_EQ(bad_rows({"0", "0", "2147483648", "1073741824", "0", "0", "0", "0"}), "..xx....") << "OPC UA";
    EXPECT_EQ(bad_rows({"0", "1", "0", "1", "1", "1", "0", "0"}), "........") << "either may be good";
}

TEST(LoopsReader, QualityOfALongFileBelongsToItsLine) {
    std::string text = "Time,Tag,Value,Quality\n";
    for (int k = 0; k < 20; ++k)
        for (const char* part : {".PV", ".OP"})
            text += std::to_string(k) + ",FIC1" + part + "," + std::to_string(k) + "," +
                    (k == 5 && *(part + 1) == 'P' ? "Bad" : "Good") + "\n";
    const TaggedLoop loop = loop_of(read_file(text), "FIC1");
    ASSERT_EQ(loop.t.size(), 20u);
    EXPECT_TRUE(std::isnan(loop.y[5]) && loop.u[5] == 5);
    EXPECT_EQ(loop.bad, 1);
}

TEST(LoopsReader, TagsOfALongFileHaveTheirOwnClocks) {
    std::string text = "Time,Tag,Value\n";
    for (int k = 0; k < 100; ++k) {
        text += std::to_string(10 * k + 3) + ",FIC1.PV," + std::to_string(k) + "\n";
        if (k % 4 == 0) text += std::to_string(10 * k + 5) + ",FIC1.OP," + std::to_string(2 * k) + "\n";
        if (k == 0 || k == 50) text += std::to_string(10 * k) + ",FIC1.SP," + std::to_string(k) + "\n";
    }
    const TaggedLoop loop = loop_of(read_file(text), "FIC1");
    ASSERT_EQ(loop.t.size(), 100u) << "the rows are the times of PV";
    EXPECT_TRUE(std::isnan(loop.u[0])) << "OP begins later";
    for (std::size_t k = 1; k < 100; ++k) {
        EXPECT_EQ(loop.t[k], 10.0 * static_cast<double>(k) + 3);
        EXPECT_EQ(loop.u[k], 2.0 * std::floor((static_cast<double>(k) - 0.1) / 4) * 4) << k;
        EXPECT_EQ(loop.r[k], k < 50 ? 0 : 50);
    }
}

TEST(LoopsReader, ASilenceIsHeldIfYIsStoredByChangesAndAGapIfItIsSampled) {
    const auto rows_between = [](bool sampled) {
        std::string text = "Time,Tag,Value\n";
        int t = 0;
        for (int k = 0; k < 60; ++k) {
            t += k == 30 ? 500 : sampled ? 10 : 1 + (k * k) % 17;
            text += std::to_string(t) + ",FIC1.PV," + std::to_string(k) + "\n";
        }
        const int end = t;
        for (t = 0; t <= end; t += 10) text += std::to_string(t) + ",FIC1.OP," + std::to_string(t) + "\n";
        const TaggedLoop loop = loop_of(read_file(text), "FIC1");
        return std::ranges::count(loop.y, 29.0);
    };
    EXPECT_EQ(rows_between(true), 1);
    EXPECT_NEAR(static_cast<double>(rows_between(false)), 50, 2);
}

TEST(LoopsReader, AMeasurementThatStandsStillHasTheRowsOfTheOutput) {
    std::string text = "Time,Tag,Value\n0,FIC1.PV,7\n4000,FIC1.PV,7\n";
    for (int k = 0; k < 500; ++k) text += std::to_string(k * 10) + ",FIC1.OP," + std::to_string(k % 9) + "\n";
    const TaggedLoop loop = loop_of(read_file(text), "FIC1");
    EXPECT_EQ(loop.t.size(), 500u);
    EXPECT_THAT(loop.y, Each(7));
}

TEST(LoopsReader, AnExportByChangesInColumnsIsJoinedLikeTags) {
    std::string text = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
    for (int k = 0; k < 80; ++k) {
        const std::string n = std::to_string(k);
        text += n + "," + (k % 2 == 0 ? n : "") + "," + (k % 2 == 1 ? n : "") + "," + n + "," + n + "\n";
    }
    const ReadFile file = read_file(text);
    const TaggedLoop& loop = loop_of(file, "FIC1");
    ASSERT_EQ(loop.t.size(), 40u);
    EXPECT_EQ(loop.t[7], 14);
    EXPECT_EQ(loop.u[7], 13) << "held";
    EXPECT_EQ(loop_of(file, "FIC2").t.size(), 80u);
}

TEST(LoopsReader, EachValueBelongsToTheNearestTimeOnItsLeft) {
    std::string text = "Time 1,FIC1.PV,Time 2,FIC1.OP,Time 3,FIC2.PV,Time 4,FIC2.OP\n";
    for (int k = 0; k < 30; ++k) {
        const auto at = [&](int offset) {
            return "2026-05-04 06:" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ":0" +
                   std::to_string(offset);
        };
        const std::string n = std::to_string(k);
        text += at(0) + "," + n + ".5," + at(2) + "," + n + "," + at(5) + "," + n + ".5," + at(3) + "," + n + "\n";
    }
    const ReadFile file = read_file(text);
    ASSERT_EQ(file.loops.size(), 2u) << file.refusal;
    EXPECT_TRUE(std::isnan(file.loops[0].u[0])) << "OP comes two seconds later";
    EXPECT_EQ(file.loops[0].u[1], 0);
    EXPECT_EQ(file.loops[1].u[1], 1) << "OP comes two seconds earlier";
    EXPECT_EQ(file.loops[1].t[1], 65);
}

TEST(LoopsReader, ReadsAFileOfOneLoop) {
    std::string text = "t,sp,pv,op,mode\n";
    for (int k = 0; k < 30; ++k) text += std::to_string(k) + ",50," + std::to_string(49 + k % 3) + ",30,AUTO\n";
    LoopsOptions options;
    options.name = "FIC7";
    for (const std::string& headings : {std::string("t,sp,pv,op,mode"), std::string("Time,Setpoint,Flow,Valve,Mode")}) {
        std::string named = text;
        named.replace(0, named.find('\n'), headings);
        const ReadFile file = read_file(named, options);
        ASSERT_EQ(file.loops.size(), 1u) << headings << file.refusal;
        EXPECT_EQ(file.loops[0].tag, "FIC7");
        EXPECT_EQ(file.loops[0].r[3], 50);
        EXPECT_EQ(file.loops[0].mode_words[file.loops[0].mode[3]], "AUTO");
        EXPECT_EQ(file.loops[0].epoch, std::nullopt);
    }
    text.replace(0, text.find('\n'), "t,FIC8.SP,FIC8.PV,FIC8.OP,FIC8.MODE");
    EXPECT_EQ(read_file(text, options).loops.at(0).tag, "FIC8");
}

TEST(LoopsReader, CodesOfModesNeedAMeaning) {
    const auto with_codes = [](const std::string& heading) {
        std::string text = "t,FIC1.PV,FIC1.OP," + heading + "\n";
        for (int k = 0; k < 9; ++k)
            text += std::to_string(k) + "," + std::to_string(k) + ".5,3," + std::to_string(k / 3) + "\n";
        return read_file(text).loops.at(0);
    };
    const TaggedLoop stated = with_codes("FIC1.MODE (0=MAN 1=AUTO)");
    EXPECT_THAT(stated.mode_words, ElementsAre("", "MAN", "AUTO", "code 2"));
    EXPECT_THAT(stated.mode, ElementsAre(1, 1, 1, 2, 2, 2, 3, 3, 3));
    const TaggedLoop open = with_codes("FIC1.MODE");
    EXPECT_THAT(open.mode, IsEmpty());
    EXPECT_THAT(open.notes,
                Contains(HasSubstr("The mode \"FIC1.MODE\" holds codes such as 0 whose meaning is not stated")));
}

TEST(LoopsReader, TimesThatStartAgainGoOn) {
    std::string text = "t,FIC1.PV,FIC1.OP\n";
    for (int run = 0; run < 3; ++run)
        for (int k = 0; k < 20; ++k)
            text += std::to_string(k * 10) + "," + std::to_string(run) + ".5," + std::to_string(k) + "\n";
    const ReadFile file = read_file(text);
    ASSERT_EQ(file.loops.size(), 1u) << file.refusal;
    EXPECT_EQ(file.loops[0].t.size(), 60u);
    EXPECT_EQ(file.loops[0].t[20], 200);
    EXPECT_EQ(file.loops[0].t.back(), 590);
    EXPECT_THAT(file.notes, Contains("The times start again 2 times; the rows were joined one after the other."));
}

TEST(LoopsReader, CountersSince1970AndSpreadsheetsDaysHaveADate) {
    const auto epoch_of = [](const std::string& heading, double first, double step) {
        std::string text = heading + ",FIC1.PV,FIC1.OP\n";
        for (int k = 0; k < 30; ++k) {
            char line[80];
            std::snprintf(line, sizeof line, "%.10f,%d.5,%d\n", first + step * k, k, k);
            text += line;
        }
        const TaggedLoop loop = read_file(text).loops.at(0);
        EXPECT_NEAR(loop.t[1] - loop.t[0], 10, 1e-3) << heading;
        return loop.epoch ? *loop.epoch + loop.t[0] : -1;
    };
    EXPECT_NEAR(epoch_of("time", 1777874400000.0, 10000), 1777874400, 1e-3);
    EXPECT_NEAR(epoch_of("timestamp", 1777874400.0, 10), 1777874400, 1e-3);
    EXPECT_NEAR(epoch_of("Date", 46146.25, 10.0 / 86400), 1777874400, 1e-3);
    EXPECT_EQ(epoch_of("t [s]", 0, 10), -1);
    EXPECT_NEAR(epoch_of("t [min]", 0, 10.0 / 60), -1, 1e-9);
}

TEST(LoopsReader, GivesTimesInTheUnitThatIsAskedFor) {
    LoopsOptions options;
    options.time_unit = "min";
    options.time_unit_given = true;
    const TaggedLoop loop = loop_of(read_file(recorded::wide_file(), options), "FIC101");
    EXPECT_DOUBLE_EQ(loop.t.back(), (kRows - 1) * kStep / 60.0);
    EXPECT_EQ(loop.epoch, 1777874400);
}

TEST(LoopsReader, RefusesWithTheCure) {
    LoopsOptions small;
    small.max_numbers = 100;
    EXPECT_EQ(
        read_file(recorded::wide_file(), small).refusal,
        "The file has more than 100 values and times. Send it in parts, with fewer loops or a shorter time in each, or "
        "export fewer rows.");
    EXPECT_THAT(read_file("").refusal, HasSubstr("empty"));
    EXPECT_THAT(read_file("Time,FIC1.PV,FIC1.OP\n").refusal, HasSubstr("heading"));
    EXPECT_THAT(read_file("Time,TI1.PV,TI2.PV\n1,2,3\n2,3,4\n3,4,5\n").refusal, HasSubstr("No loop was found."));
    EXPECT_THAT(read_file("FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n3,2,3,1\n2,3,1,9\n3,4,5,2\n").refusal,
                HasSubstr("no column of times"));
    EXPECT_THAT(read_file("Time,Tag,PV,OP\nx,FIC1,1,2\ny,FIC1,1,2\nz,FIC2,1,2\n").refusal, HasSubstr("time"));
    std::string wide = "Time";
    for (int k = 0; k < 4100; ++k) wide += ",F" + std::to_string(k) + ".PV";
    EXPECT_THAT(read_file(wide + "\n" + wide + "\n").refusal, HasSubstr("4101 columns; at most 4000"));
}

TEST(LoopsReader, ReadsLinesBehindTheHeadAlike) {
    std::string text = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
    constexpr int kMany = 12000;
    for (int k = 0; k < kMany; ++k) {
        const std::string n = std::to_string(k);
        text += n + "," + n + ".25," + n + "," + n + "," + n + "\n";
        if (k % 1000 == 0) text += "# a remark\n\nTime,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
    }
    const ReadFile file = read_file(text);
    ASSERT_EQ(file.loops.size(), 2u);
    ASSERT_EQ(file.loops[0].t.size(), static_cast<std::size_t>(kMany));
    EXPECT_EQ(file.loops[0].y.back(), kMany - 0.75);
    EXPECT_THAT(file.notes, IsEmpty());
}

}  // namespace
}  // namespace tunewright::api
