// The mode of the loop in a file: its column, its words, its codes.
#include <gmock/gmock.h>

#include "api/csv/columns/loop_mode.h"
#include "api/csv/csv_record.h"
#include "api/csv/preview.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Six rows with these modes under `heading`; y is TIC101.PV.
std::string with_modes(const std::string& heading, const std::vector<std::string>& modes) {
    std::string out = "Time;TIC101.PV;TIC101.OP;TIC101.SP;" + heading + "\n";
    for (std::size_t k = 0; k < modes.size(); ++k)
        out += std::to_string(k) + ";" + std::to_string(20 + k) + ";" + std::to_string(40 + k % 3) + ";30;" + modes[k] +
               "\n";
    return out;
}

CsvRecord read(const std::string& text, const CsvOptions& options = {}) {
    auto out = read_csv_record(text, options);
    if (auto* faults = std::get_if<std::vector<CsvFault>>(&out)) {
        ADD_FAILURE() << faults->front().where << ": " << faults->front().message;
        return {};
    }
    return std::get<CsvRecord>(std::move(out));
}

TEST(CsvMode, IsReadUnderTheHeadingsOfHistorians) {
    struct Case {
        const char* heading;
        std::vector<std::string> modes;
    };
    for (const auto& [heading, modes] : {Case{"MODE", {"AUTO", "AUTO", "MAN", "MAN", "CAS", "CAS"}},
                                         {"TIC101.MODE", {"Auto", "auto", "Man", "MAN", "Cas", "RCAS"}},
                                         {"TIC101/MODE.ACTUAL", {"AUT", "AUT", "IMAN", "OOS", "CAS", "CAS"}},
                                         {"Actual Mode", {"A", "A", "M", "M", "C", "A"}},
                                         {"A/M", {"A", "A", "M", "M", "A", "A"}},
                                         {"TIC101.A/M", {"A", "A", "M", "M", "A", "A"}},
                                         {"Betriebsart", {"Automatik", "Auto", "Hand", "hand", "Kaskade", "AUTO"}},
                                         {"Hand/Automatik", {"Automatik", "", "Hand", "", "Automatik", ""}},
                                         {"Mode (0=MAN, 1=AUTO, 2=CAS)", {"1", "1", "0", "0", "2", "2"}},
                                         {"Mode [1: man; 4: auto]", {"4", "4.0", "1", "1", "4", "4"}},
                                         {"TIC101.AUTO", {"1", "1", "0", "0", "1", "1"}},
                                         {"Auto", {"TRUE", "TRUE", "FALSE", "FALSE", "TRUE", "TRUE"}},
                                         {"Auto=1", {"1", "1", "0", "0", "1", "1"}},
                                         {"MANUAL", {"0", "0", "1", "1", "0", "0"}},
                                         {"MAN_ON", {"off", "off", "on", "on", "off", "off"}}}) {
        std::string text = with_modes(heading, modes);
        if (std::string(heading).find(';') != std::string::npos)
            text.replace(text.find(heading), std::string(heading).size(), "\"" + std::string(heading) + "\"");
        const CsvRecord record = read(text);
        EXPECT_THAT(record.automatic, ElementsAre(true, true, false, false, true, true)) << heading;
        EXPECT_EQ(record.unknown_mode, "") << heading;
        EXPECT_EQ(record.y[1], 21) << heading;
        EXPECT_EQ(record.u[1], 41) << heading;
        EXPECT_EQ(record.r[1], 30) << heading;
    }
}

TEST(CsvMode, ANoteNamesItsColumn) {
    EXPECT_THAT(read(with_modes("TIC101.MODE", {"AUTO", "AUTO", "MAN", "MAN", "CAS", "CAS"})).notes,
                Contains("Column \"TIC101.MODE\" is read as mode, the mode of the loop."));
}

TEST(CsvMode, IsNotReadFromWhatIsNoModeOfThisLoop) {
    const std::vector<std::string> words = {"AUTO", "AUTO", "MAN", "MAN", "CAS", "CAS"};
    for (const char* heading : {"FIC205.MODE", "TIC101.MODE.TARGET", "Normal Mode", "Comment"})
        EXPECT_THAT(read(with_modes(heading, words)).automatic, IsEmpty()) << heading;
    // A thermostat's mode says what it does, not who moves u.
    EXPECT_THAT(read(with_modes("hvac_mode", {"heat", "heat", "cool", "off", "auto", "heat"})).automatic, IsEmpty());
}

TEST(CsvMode, ANumberInTheTagBelongsToTheTag) {
    const CsvRecord record = read(
        "Time;TIC-101.PV;TIC-101.OP;TIC-101.MODE;TIC-102.MODE\n0;20;40;MAN;AUTO\n1;21;41;AUTO;AUTO\n2;22;40;AUTO;"
        "MAN\n");
    EXPECT_THAT(record.automatic, ElementsAre(false, true, true));
}

TEST(CsvMode, NumbersWithoutAMeaningAreNotReadAndNamed) {
    const std::string text = with_modes("Mode", {"1", "1", "0", "0", "1", "1"});
    const CsvRecord record = read(text);
    EXPECT_THAT(record.automatic, IsEmpty());
    EXPECT_THAT(record.notes,
                Contains(HasSubstr("Column \"Mode\" holds numbers, and its heading does not say which is "
                                   "automatic: the mode is not read. Name it such as \"Mode (0=MAN, 1=AUTO)\".")));
    CsvOptions options;
    options.columns.mode = "Mode";
    const auto chosen = read_csv_record(text, options);
    const auto* faults = std::get_if<std::vector<CsvFault>>(&chosen);
    ASSERT_NE(faults, nullptr);
    EXPECT_EQ(faults->front().where, "columns/mode");
}

TEST(CsvMode, UnknownWordsCountAsManualAndAreNamed) {
    const CsvRecord record = read(with_modes("MODE", {"AUTO", "AUTO", "WARMUP", "WARMUP", "AUTO", "AUTO"}));
    EXPECT_THAT(record.automatic, ElementsAre(true, true, false, false, true, true));
    EXPECT_EQ(
        record.unknown_mode,
        "\"WARMUP\" is not a known mode of the loop: 2 rows count as manual. Known are AUTO and CAS for automatic, "
        "and MAN.");
    CsvOptions options;
    options.columns.mode = 5;
    const CsvRecord chosen = read(with_modes("Zustand", {"x", "x", "y", "y", "x", "x"}), options);
    EXPECT_THAT(chosen.automatic, IsEmpty()) << "no known word";
    EXPECT_THAT(chosen.unknown_mode, HasSubstr("\"x\" and \"y\" are not known modes, so the mode is not used"));
}

TEST(CsvMode, HoldsUntilTheNextOneAlsoFromRowsThatAreLeftOut) {
    // The mode is logged in a line of its own; the first rows have that of the first entry.
    std::string text = "t,u,y,mode\n0,40,20,\n1,41,21,\n";
    text += "1.5,,,MAN\n2,42,22,\n3,43,23,Bad\n3.5,,,AUTO\n4,44,24,\n5,41,25,\n";
    EXPECT_THAT(read(text).automatic, ElementsAre(false, false, false, false, true, true));
}

TEST(CsvMode, KeepsToItsRowsInTablesOfTagsAndInRuns) {
    std::string tags = "time,tag,value\n";
    for (int k = 0; k < 12; ++k) {
        tags += std::to_string(k) + ",TIC101.PV," + std::to_string(20 + k) + "\n";
        tags += std::to_string(k) + ",TIC101.OP," + std::to_string(40 + k % 5) + "\n";
        if (k == 0 || k == 7) tags += std::to_string(k) + ",TIC101.MODE," + (k == 0 ? "MAN" : "AUTO") + "\n";
    }
    const CsvRecord table = read(tags);
    ASSERT_EQ(table.automatic.size(), table.t.size());
    for (std::size_t k = 0; k < table.t.size(); ++k) EXPECT_EQ(table.automatic[k], table.t[k] >= 7) << table.t[k];

    std::string runs = "t,u,y,mode\n";
    for (int run = 0; run < 2; ++run)
        for (int k = 0; k < 30; ++k)
            runs += std::to_string(k) + "," + std::to_string(k < 5 ? 1 : 2) + "," + std::to_string(run * 3 + k) + "," +
                    (run == 0 ? "MAN"
                     : k < 10 ? "CAS"
                              : "AUTO") +
                    "\n";
    CsvOptions options;
    options.run = 1;
    EXPECT_THAT(read(runs, options).automatic, Not(Contains(true)));
    options.run = 2;
    const CsvRecord second = read(runs, options);
    ASSERT_EQ(second.automatic.size(), 30u);
    EXPECT_THAT(second.automatic, Not(Contains(false)));
}

TEST(CsvMode, IsShownInThePreview) {
    const CsvPreview preview = preview_csv(with_modes("MODE", {"AUTO", "AUTO", "XYZ", "MAN", "CAS", "AUTO"}), {});
    EXPECT_EQ(preview.columns.back().guess, "mode");
    EXPECT_EQ(preview.columns.back().confidence, 1);
    EXPECT_THAT(preview.notes, Contains(HasSubstr("\"XYZ\" is not a known mode")));
}

}  // namespace
}  // namespace tunewright::api
