// Records of many loops as a batch: a request for each loop.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "api/batch/reader.h"
#include "api/csv/csv_record.h"
#include "api/historian/loop_request.h"
#include "api/json/json.h"
#include "tests/api/historian/recorded_plant.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

BatchQuestion of_records() {
    BatchQuestion question;
    question.form = BatchForm::csv;
    question.kind = BatchKind::check;
    return question;
}

struct ReadBatch {
    std::vector<BatchEntry> entries;
    std::string refusal;
    std::size_t largest_portion = 0;
};

ReadBatch read_records(const BatchQuestion& question, std::string_view body, std::size_t piece = 1000) {
    ReadBatch out;
    BatchReader reader(question);
    std::optional<Problem> problem;
    for (std::size_t at = 0; at < body.size() && !problem; at += piece)
        problem = reader.feed(body.substr(at, piece), out.entries);
    do {
        std::vector<BatchEntry> portion;
        if (!problem) problem = reader.finish(portion);
        out.largest_portion = std::max(out.largest_portion, portion.size());
        for (BatchEntry& entry : portion) out.entries.push_back(std::move(entry));
    } while (!problem && reader.more());
    if (problem) out.refusal = problem->detail;
    return out;
}

Json request_in(const BatchEntry& entry) {
    const auto* job = std::get_if<PreparedJob>(&entry.job);
    return job ? Json::parse(job->request_json) : Json(std::get<Problem>(entry.job).detail);
}

TEST(RecordedLoops, BecomeARequestEach) {
    for (const std::string& file : {recorded::wide_file(), recorded::long_file(), recorded::rows_file()}) {
        const ReadBatch batch = read_records(of_records(), file);
        ASSERT_EQ(batch.refusal, "");
        ASSERT_EQ(batch.entries.size(), recorded::kTags.size());
        EXPECT_EQ(batch.entries[1].name, "TIC-102");
        const Json request = request_in(batch.entries[1]);
        ASSERT_TRUE(request.is_object()) << request;
        const Json& loop = request.at("loops").at(0);
        EXPECT_EQ(loop.at("tag"), "TIC-102");
        EXPECT_EQ(loop.at("kind"), "temperature");
        EXPECT_EQ(loop.at("start"), "2026-05-04T06:00:00");
        EXPECT_EQ(loop.at("time_unit"), "s");
        EXPECT_EQ(loop.at("columns"), Json({{"t", 1}, {"r", 2}, {"y", 3}, {"u", 4}, {"mode", 5}}));
    }
}

TEST(RecordedLoops, DoNotDependOnTheCuts) {
    const auto all_requests = [](const ReadBatch& batch) {
        std::string out;
        for (const BatchEntry& entry : batch.entries) out += request_in(entry).dump() + "\n";
        return out;
    };
    const std::string whole = all_requests(read_records(of_records(), recorded::wide_file(), 1'000'000));
    for (const std::size_t piece : {1, 7, 64})
        EXPECT_EQ(all_requests(read_records(of_records(), recorded::wide_file(), piece)), whole);
    BatchQuestion open = of_records();
    open.form.reset();
    EXPECT_EQ(all_requests(read_records(open, recorded::wide_file(), 7)), whole);
}

/// A loop with numbers of three decimals, whole numbers, blanks and a mode that needs quotes.
TaggedLoop awkward_loop() {
    TaggedLoop loop;
    loop.tag = "FIC \"1\"";
    loop.t = {100, 110, 120.5, 130};
    loop.y = {57.228, std::nan(""), 100, 1e-9};
    loop.u = {250, 12.345, std::nan(""), 100};
    loop.r = {std::nan(""), 50.125, 50.125, 500};
    loop.mode = {0, 1, 1, 2};
    loop.mode_words = {"", "AUTO", "MAN, forced"};
    loop.epoch = 1777874400.5;
    loop.utc = true;
    return loop;
}

TEST(RecordedLoops, ReadBackAsTheSameNumbers) {
    const TaggedLoop loop = awkward_loop();
    const Json request = Json::parse(loop_request(loop, {}));
    EXPECT_FALSE(request.contains("units"));
    const Json& sent = request.at("loops").at(0);
    EXPECT_EQ(sent.at("start"), "2026-05-04T06:01:40.5Z");
    CsvOptions options;
    options.columns = {1, 4, 3, 2, 5};
    const auto read = read_csv_record(sent.at("csv").get<std::string>(), options);
    ASSERT_TRUE(std::holds_alternative<CsvRecord>(read)) << std::get<std::vector<CsvFault>>(read).front().message;
    const auto& record = std::get<CsvRecord>(read);
    ASSERT_EQ(record.t.size(), loop.t.size());
    for (std::size_t i = 0; i < loop.t.size(); ++i) {
        EXPECT_EQ(record.t[i], loop.t[i] - 100);
        EXPECT_TRUE(record.y[i] == loop.y[i] || (std::isnan(record.y[i]) && std::isnan(loop.y[i]))) << i;
        EXPECT_TRUE(record.u[i] == loop.u[i] || (std::isnan(record.u[i]) && std::isnan(loop.u[i]))) << i;
    }
    EXPECT_EQ(record.r[3], 500);
    EXPECT_THAT(record.unknown_mode, HasSubstr("MAN, forced"));
}

TEST(RecordedLoops, HaveTheUnitThatIsAskedFor) {
    BatchQuestion question = of_records();
    question.time_unit = "min";
    const Json request = request_in(read_records(question, recorded::wide_file()).entries.at(0));
    EXPECT_EQ(request.at("units").at("time"), "min");
    EXPECT_EQ(request.at("loops").at(0).at("time_unit"), "min");
    EXPECT_THAT(request.at("loops").at(0).at("csv").get<std::string>(), HasSubstr("\n1,,"));
    question.form = BatchForm::ndjson;
    EXPECT_THAT(read_records(question, "{}").refusal, HasSubstr("units.time is a parameter for records"));
}

TEST(RecordedLoops, FailAlone) {
    std::string body = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
    for (int k = 0; k < 30; ++k) body += std::to_string(k) + ",Bad,3," + std::to_string(k % 7) + ".5,4\n";
    const ReadBatch batch = read_records(of_records(), body);
    ASSERT_EQ(batch.entries.size(), 2u);
    EXPECT_EQ(batch.entries[0].name, "FIC1");
    EXPECT_THAT(std::get<Problem>(batch.entries[0].job).detail,
                HasSubstr("Request 1, FIC1: FIC1.PV has no value of good quality."));
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(batch.entries[1].job));
    BatchQuestion small = of_records();
    small.longest_entry = 300;
    EXPECT_THAT(request_in(read_records(small, body).entries.at(1)),
                HasSubstr("Send a shorter time, or export fewer rows."));
}

TEST(RecordedLoops, ComeInPortions) {
    constexpr int kLoops = 40, kManyRows = 4000;
    std::string text = "Time";
    for (int loop = 0; loop < kLoops; ++loop)
        text += ",F" + std::to_string(loop) + ".PV,F" + std::to_string(loop) + ".OP";
    for (int row = 0; row < kManyRows; ++row) {
        text += "\n" + std::to_string(row);
        for (int loop = 0; loop < kLoops; ++loop) text += ",12.3456789,45.6";
    }
    const ReadBatch batch = read_records(of_records(), text, 1 << 16);
    ASSERT_EQ(batch.refusal, "");
    EXPECT_EQ(batch.entries.size(), static_cast<std::size_t>(kLoops));
    EXPECT_LT(batch.largest_portion, static_cast<std::size_t>(kLoops) / 2);
}

std::string form_part(const std::string& head, const std::string& content) {
    return "--cut\r\nContent-Disposition: form-data; " + head + "\r\n\r\n" + content + "\r\n";
}

std::string as_file(const std::string& name, const std::string& content) {
    return form_part("name=\"file\"; filename=\"" + name + "\"", content);
}

ReadBatch read_form(const std::string& parts, std::vector<std::string>* notes = nullptr, std::size_t piece = 1000) {
    BatchQuestion question = of_records();
    question.form = BatchForm::files;
    question.boundary = "cut";
    ReadBatch out;
    BatchReader reader(question);
    const std::string body = parts + "--cut--\r\n";
    std::optional<Problem> problem;
    for (std::size_t at = 0; at < body.size() && !problem; at += piece)
        problem = reader.feed(std::string_view(body).substr(at, piece), out.entries);
    do {
        if (!problem) problem = reader.finish(out.entries);
    } while (!problem && reader.more());
    if (problem) out.refusal = problem->detail;
    if (notes != nullptr) *notes = reader.notes();
    return out;
}

TEST(RecordedFiles, AreLoopsWithWhatIsKnownOfThem) {
    const std::string table =
        form_part("name=\"loops\"", "tag,kind,op_low,op_high,weight\nTIC-102,flow,0,50,3\nX,flow,,,\n");
    const std::string day = as_file("day.csv", recorded::wide_file());
    for (const std::string& body : {table + day, day + table}) {
        std::vector<std::string> notes;
        const ReadBatch batch = read_form(body, &notes, 777);
        ASSERT_EQ(batch.refusal, "");
        ASSERT_EQ(batch.entries.size(), recorded::kTags.size());
        const Json loop = request_in(batch.entries[2]).at("loops").at(0);
        EXPECT_EQ(loop.at("tag"), "TIC-102");
        EXPECT_EQ(loop.at("kind"), "flow");
        EXPECT_EQ(loop.at("range"), Json({{"op", {0, 50}}}));
        EXPECT_EQ(loop.at("weight"), 3);
        EXPECT_FALSE(request_in(batch.entries[0]).at("loops").at(0).contains("weight"));
        EXPECT_THAT(notes, testing::ElementsAre("X is in the table of loops, but no record has this tag."));
    }
}

TEST(RecordedFiles, OfOneTagEachMakeALoop) {
    std::string pv = "Time,Value\n", op = pv;
    for (int k = 0; k < 30; ++k) {
        pv += std::to_string(k) + "," + std::to_string(k % 7) + ".5\n";
        op += std::to_string(k) + "," + std::to_string(k % 5) + ".5\n";
    }
    const ReadBatch batch = read_form(as_file("FIC1.PV.csv", pv) + as_file("FIC1.OP.csv", op));
    ASSERT_EQ(batch.refusal, "");
    ASSERT_EQ(batch.entries.size(), 1u);
    const Json loop = request_in(batch.entries[0]).at("loops").at(0);
    EXPECT_EQ(loop.at("tag"), "FIC1");
    EXPECT_THAT(loop.at("notes").dump(), HasSubstr("each has a file of its own"));
    EXPECT_THAT(read_form(as_file("FIC1.PV.csv", pv)).refusal, HasSubstr("No loop was found"));
}

TEST(RecordedFiles, AreRefusedTogetherIfTheFormIsNotValid) {
    const std::string day = as_file("day.csv", recorded::wide_file());
    EXPECT_THAT(read_form(day + form_part("name=\"loops\"", "tag,kind\nA,flw\n")).refusal,
                HasSubstr("Line 2, kind: kind is"));
    EXPECT_THAT(read_form(day + form_part("name=\"other\"", "x")).refusal, HasSubstr("a part other"));
    EXPECT_THAT(read_form(form_part("name=\"loops\"", "tag\nA\n")).refusal, HasSubstr("no file"));
    EXPECT_THAT(read_form(as_file("a.csv", "x\n")).refusal, HasSubstr("line"));
    const ReadBatch some = read_form(as_file("a.csv", "x\n") + day);
    ASSERT_EQ(some.entries.size(), 4u);
    EXPECT_EQ(some.entries[0].name, "a.csv");
    EXPECT_TRUE(std::holds_alternative<Problem>(some.entries[0].job));
}

TEST(RecordedLoops, KeepTheFindingsOfReading) {
    std::string body = "Time,FIC1.PV,FIC1.OP,FIC2.PV,FIC2.OP\n";
    for (int k = 0; k < 30; ++k)
        body += std::to_string(k) + "," + (k == 7 || k == 9 ? "Bad" : std::to_string(k % 7) + ".5") + ",4.5," +
                std::to_string(k % 7) + ".5," + (k == 5 ? "what" : "4.5") + "\n";
    const ReadBatch batch = read_records(of_records(), body);
    ASSERT_EQ(batch.entries.size(), 2u);
    EXPECT_EQ(request_in(batch.entries[0]).at("loops").at(0).at("notes"),
              Json({"2 values of the measurement or the output are of bad quality and count as missing."}));
    EXPECT_EQ(request_in(batch.entries[1]).at("loops").at(0).at("notes"),
              Json({"1 value of \"FIC2.OP\" is not a number (\"what\"); it counts as missing."}));
}

TEST(RecordedLoops, AreRefusedTogetherIfTheFileIsNone) {
    EXPECT_THAT(read_records(of_records(), "name,K,T,L\na,1,2,3\n").refusal, HasSubstr("No loop was found."));
    EXPECT_THAT(read_records(of_records(), "").refusal, HasSubstr("empty"));
    EXPECT_THAT(read_records(of_records(), "Time," + std::string(2'000'000, 'x')).refusal,
                HasSubstr("more than 1 MiB"));
}

}  // namespace
}  // namespace tunewright::api
