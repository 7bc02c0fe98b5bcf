// Batches as they arrive: every cut of the body gives the same requests, and faults are reported.
#include <algorithm>

#include <gmock/gmock.h>

#include "api/batch/reader.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Outcome {
    std::vector<BatchEntry> entries;
    std::optional<Problem> problem;
    std::string name;
};

BatchQuestion form(BatchForm form) {
    BatchQuestion question;
    question.form = form;
    return question;
}

BatchQuestion loops(LoopOptions options = {}) {
    BatchQuestion question = form(BatchForm::csv);
    question.options = std::move(options);
    return question;
}

Outcome read_pieces(const BatchQuestion& question, std::string_view body, std::size_t piece) {
    Outcome out;
    BatchReader reader(question);
    for (std::size_t at = 0; at < body.size() && !out.problem; at += piece)
        out.problem = reader.feed(body.substr(at, piece), out.entries);
    if (!out.problem) out.problem = reader.finish(out.entries);
    out.name = reader.name();
    return out;
}

/// The outcome as text: the same for every cut of the body.
std::string shown(const Outcome& outcome) {
    std::string text = outcome.name + "\n";
    for (const BatchEntry& entry : outcome.entries) {
        const auto* job = std::get_if<PreparedJob>(&entry.job);
        text += entry.name + "|" + (job ? job->request_json : to_json(std::get<Problem>(entry.job))) + "\n";
    }
    if (outcome.problem) text = "refused: " + to_json(*outcome.problem);
    return text;
}

Outcome read(const BatchQuestion& question, std::string_view body) {
    const Outcome whole = read_pieces(question, body, std::max<std::size_t>(body.size(), 1));
    for (const std::size_t piece : {1, 2, 3, 7, 64})
        EXPECT_EQ(shown(read_pieces(question, body, piece)), shown(whole))
            << "in pieces of " << piece << " of " << body;
    return whole;
}

std::string refusal(const BatchQuestion& question, std::string_view body) {
    const Outcome out = read(question, body);
    return out.problem ? std::to_string(out.problem->status) + " " + out.problem->detail : "it was read";
}

Json request_of(const BatchEntry& entry) {
    const auto* job = std::get_if<PreparedJob>(&entry.job);
    return job ? Json::parse(job->request_json) : Json(std::get<Problem>(entry.job).detail);
}

const Problem& problem_of(const BatchEntry& entry) { return std::get<Problem>(entry.job); }

const std::string kPlant = R"({"type": "fopdt", "K": 2, "T": 10, "L": 3})";

TEST(BatchReader, FindsTheRequestsOfAJsonArray) {
    const std::string body =
        "\xEF\xBB\xBF {\"name\" : \"unit \\\"7\\\"\", \"jobs\" : [ {\"name\": \"a ] } \\\" ,\", \"plant\": " + kPlant +
        "},\n{\"plant\":" + kPlant + ", \"tune\": [{\"method\": \"simc\"}]} ] }\n";
    const Outcome out = read(form(BatchForm::json), body);
    ASSERT_FALSE(out.problem) << out.problem->detail;
    EXPECT_EQ(out.name, "unit \"7\"");
    ASSERT_EQ(out.entries.size(), 2u);
    EXPECT_EQ(out.entries[0].name, "a ] } \" ,");
    EXPECT_EQ(request_of(out.entries[1])["tune"][0]["method"], "simc");
}

TEST(BatchReader, AsksForNoTracesUnlessTheRequestDoes) {
    const std::string body = "{\"plant\": " + kPlant + "}\n{\"plant\": " + kPlant +
                             ", \"evaluate\": {\"load_step\": 2}}\n{\"plant\": " + kPlant +
                             ", \"evaluate\": {\"points\": 50}}\n";
    const Outcome out = read(form(BatchForm::ndjson), body);
    ASSERT_EQ(out.entries.size(), 3u);
    EXPECT_EQ(request_of(out.entries[0])["evaluate"], Json({{"points", 0}}));
    EXPECT_EQ(request_of(out.entries[1])["evaluate"], Json({{"load_step", 2}, {"points", 0}}));
    EXPECT_EQ(request_of(out.entries[2])["evaluate"], Json({{"points", 50}}));
}

TEST(BatchReader, NamesTheLineOfABadRequestAndReadsTheOthers) {
    const std::string good = "{\"plant\": " + kPlant + "}";
    const Outcome out =
        read(form(BatchForm::ndjson), good + "\n\n  \r\n" +
                                          R"({"name": "bad", "plant": {"type": "fopdt", "K": 2, "T": "x", "L": -3}})" +
                                          "\r\nnot json\n5\n" + good);
    ASSERT_FALSE(out.problem);
    ASSERT_EQ(out.entries.size(), 5u);
    EXPECT_EQ(out.entries[1].name, "bad");
    const Problem& bad = problem_of(out.entries[1]);
    EXPECT_EQ(bad.status, 422);
    EXPECT_THAT(bad.detail, HasSubstr("Request 2, line 4: "));
    EXPECT_THAT(detail_at(bad.errors, "/plant/T"), HasSubstr("must be a number"));
    EXPECT_THAT(detail_at(bad.errors, "/plant/L"), HasSubstr("must be"));
    EXPECT_EQ(problem_of(out.entries[2]).status, 400);
    EXPECT_THAT(problem_of(out.entries[2]).detail, HasSubstr("Request 3, line 5: "));
    EXPECT_THAT(problem_of(out.entries[3]).detail, HasSubstr("an object"));
    EXPECT_EQ(request_of(out.entries[4])["plant"]["K"], 2);
}

TEST(BatchReader, ABadRequestOfAnArrayFailsAlone) {
    const std::string good = "{\"plant\": " + kPlant + "}";
    const Outcome out =
        read(form(BatchForm::json), "{\"jobs\": [" + good + ",\n{\"plant\": 1.2.3}, 7, \"text\", [1], " + good + "]}");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 6u);
    for (const std::size_t bad : {1, 2, 3, 4})
        EXPECT_TRUE(std::holds_alternative<Problem>(out.entries[bad].job)) << bad;
    EXPECT_THAT(problem_of(out.entries[1]).detail, HasSubstr("Request 2, line 2: "));
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(out.entries[5].job));
}

TEST(BatchReader, TellsFormsApartByTheFirstBytes) {
    const BatchQuestion open;
    const std::string request = "{\"name\": \"a\", \"plant\": " + kPlant + "}";
    for (const std::string& mark : {std::string(), std::string("\xEF\xBB\xBF"), std::string(" \n")}) {
        EXPECT_EQ(read(open, mark + "{\"name\": \"b\", \"jobs\": [" + request + "]}").name, "b");
        EXPECT_EQ(read(open, mark + request + "\n" + request).entries.size(), 2u);
        EXPECT_EQ(read(open, mark + "name,K,T,L\na,1,2,3\nb,1,2,3\n").entries.size(), 2u);
    }
    EXPECT_THAT(refusal(open, "[" + request + "]"), HasSubstr("422 The body is an array"));
    EXPECT_THAT(refusal(open, "{\"jobs\": 5}"), HasSubstr("jobs must be an array"));
    EXPECT_EQ(read(open, std::string(70000, ' ') + "{\"jobs\": [" + request + "]}").entries.size(), 1u);
}

TEST(BatchReader, OptionsBelongToLoopsAlone) {
    BatchQuestion question;
    question.options = {{"Ms", "1.6"}};
    EXPECT_EQ(read(question, "K,T,L\n1,2,3\n").entries.size(), 1u);
    EXPECT_THAT(refusal(question, "{\"plant\": 1}\n"), HasSubstr("422 Ms is a parameter for a CSV of loops"));
    EXPECT_THAT(refusal(question, "{\"jobs\": [{}]}"), HasSubstr("422 Ms is a parameter for a CSV of loops"));
}

TEST(BatchReader, RefusesABrokenArrayAsAWhole) {
    const BatchQuestion json = form(BatchForm::json);
    EXPECT_EQ(refusal(json, ""), "400 The body is empty. Send {\"jobs\": [request, request, ...]}.");
    EXPECT_THAT(refusal(json, "{\"jobs\": [{}"), HasSubstr("400 The body is not JSON: it ends too early"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{]}"),
                HasSubstr("400 The body is not JSON: ] stands at line 1, column 12 where }"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{}\n {}]}"), HasSubstr("{ stands at line 2, column 2 where a comma or ]"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{},]}"), HasSubstr("where a request should be"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{\"a\": \"b\n\"}]}"), HasSubstr("line 1 ends inside a text"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{}]} x"), HasSubstr("where the end of the body should be"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{}]"), HasSubstr("ends too early"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [" + std::string(2000, '[')), HasSubstr("more than 1000 deep"));
    EXPECT_THAT(refusal(json, "name,K,T,L"), HasSubstr("400 The body is not JSON: n stands at line 1, column 1"));
    EXPECT_THAT(refusal(json, "\x01"), HasSubstr("the byte 0x01"));
}

TEST(BatchReader, RefusesAnotherShapeWithTheCure) {
    const BatchQuestion json = form(BatchForm::json);
    EXPECT_THAT(refusal(json, "{}"), HasSubstr("422 jobs is missing"));
    EXPECT_THAT(refusal(json, "{\"plant\": 1}"), HasSubstr("422 plant is not a member of a batch"));
    EXPECT_THAT(refusal(json, "{\"plant\": 1}"), HasSubstr("application/x-ndjson"));
    EXPECT_THAT(refusal(json, "{\"jobs\": [{}], \"jobs\": [{}]}"), HasSubstr("422 jobs is given twice"));
    EXPECT_THAT(refusal(json, "{\"name\": 5, \"jobs\": [{}]}"), HasSubstr("422 name is not a string"));
    EXPECT_THAT(refusal(json, "{\"name\": \"" + std::string(201, 'x') + "\", \"jobs\": [{}]}"),
                HasSubstr("201 characters"));
    EXPECT_THAT(refusal(json, "{\"" + std::string(5000, 'x')), HasSubstr("422 A member's name"));
    EXPECT_THAT(refusal(json, "{\"jobs\": []}"), HasSubstr("422 The batch has no requests"));
    EXPECT_THAT(refusal(form(BatchForm::ndjson), "\n\n"), HasSubstr("422 The batch has no requests"));
    EXPECT_THAT(refusal(loops(), "name,K,T,L\n"), HasSubstr("422 The batch has no requests"));
    EXPECT_THAT(refusal({}, ""), HasSubstr("422 The batch has no requests"));
}

TEST(BatchReader, TellsWhatIsWrongFirst) {
    BatchQuestion question = form(BatchForm::json);
    question.max_entries = 2;
    EXPECT_THAT(refusal(question, "{\"jobs\": [{}, {}, {}, {]}"), HasSubstr("more than 2 requests"));
    EXPECT_THAT(refusal(question, "{\"jobs\": [{}, {}, {]}"), HasSubstr("400 The body is not JSON"));
}

TEST(BatchReader, TakesNoMoreRequestsThanAllowed) {
    BatchQuestion question = form(BatchForm::ndjson);
    question.max_entries = 3;
    EXPECT_EQ(read(question, "{}\n{}\n{}\n").entries.size(), 3u);
    EXPECT_THAT(refusal(question, "{}\n{}\n{}\n{}\n"), HasSubstr("422 The batch has more than 3 requests"));
}

TEST(BatchReader, ARequestThatIsTooLongFailsAloneAndIsNotKept) {
    const std::string good = "{\"plant\": " + kPlant + "}";
    const std::string big = "{\"name\": \"" + std::string(500, 'x') + "\"}";
    for (const BatchForm way : {BatchForm::json, BatchForm::ndjson}) {
        BatchQuestion question = form(way);
        question.longest_entry = 200;
        const std::string body = way == BatchForm::json ? "{\"jobs\": [" + big + "," + good + "]}" : big + "\n" + good;
        const Outcome out = read(question, body);
        ASSERT_EQ(out.entries.size(), 2u);
        EXPECT_EQ(problem_of(out.entries[0]).status, 413);
        EXPECT_THAT(problem_of(out.entries[0]).detail, HasSubstr("512 bytes; at most 200"));
        EXPECT_TRUE(std::holds_alternative<PreparedJob>(out.entries[1].job));
    }
}

TEST(BatchReader, ReadsLoopsByTheirHeadings) {
    const Outcome out = read(loops({{"method", "robust"}, {"Ms", "1.6"}, {"controller", "PI"}}),
                             "L [min];T (min);Tag;Gain\n3;10;TIC-101;2\n0,5;1,25;\"FIC \"\"A\"\"; 2\";-0,4\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 2u);
    EXPECT_EQ(request_of(out.entries[0]),
              Json::parse(
                  R"({"name": "TIC-101", "units": {"time": "min"}, "plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
                              "tune": [{"method": "robust", "Ms": 1.6, "controller": "PI"}], "evaluate": {"points": 0}})"));
    EXPECT_EQ(out.entries[1].name, "FIC \"A\"; 2");
    EXPECT_EQ(request_of(out.entries[1])["plant"], Json::parse(R"({"type": "fopdt", "K": -0.4, "T": 1.25, "L": 0.5})"));
}

TEST(BatchReader, ReadsTheLoopsOfTheDocuments) {
    const Outcome out =
        read(loops({{"method", "robust"}, {"Ms", "1.6"}, {"controller", "PI"}}), data_file("../../docs/loops.csv"));
    ASSERT_FALSE(out.problem);
    ASSERT_EQ(out.entries.size(), 5u);
    for (const BatchEntry& entry : out.entries)
        EXPECT_TRUE(std::holds_alternative<PreparedJob>(entry.job)) << entry.name;
}

TEST(BatchReader, ReadsLoopsAsProgramsWriteThem) {
    const std::string expected = R"({"type": "fopdt", "K": 1.5, "T": 20, "L": 4})";
    std::string little = "\xFF\xFE";
    for (const char c : std::string("K\tT\tL\r\n1,5\t20\t4\r\n")) little += {c, '\0'};
    for (const std::string& body :
         {std::string("sep=;\nname;K;T;L\nx;1,5;20;4\n"), std::string("# loops\n\nK\tT\tL\n1,5\t20\t4"),
          std::string("K,T,L,,\r\n\"1,5\",20,4,,\r\n,,,,\r\n"), std::string("K,T,L\r1.5,20,4\r"),
          std::string("K | T | L\n1.5 | 20 s | 4 s\n"), little}) {
        const Outcome out = read(loops(), body);
        ASSERT_FALSE(out.problem) << body << out.problem->detail;
        ASSERT_EQ(out.entries.size(), 1u) << body;
        EXPECT_EQ(request_of(out.entries[0])["plant"], Json::parse(expected)) << body;
    }
}

TEST(BatchReader, TodaysSettingsStandInColumnsOfTheirOwn) {
    const Outcome out = read(loops({{"method", "simc"}}),
                             "name;K;T [min];L [min];Kp [%/degC];Ti [min];today's Td;Tf\n"
                             "a;2;10;3;0,5;12;1;0,1\nb;2;10;3;;;;\nc;2;10;3;0,7;-;;\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 3u);
    EXPECT_EQ(request_of(out.entries[0])["baseline"],
              Json::parse(R"({"Kp": 0.5, "Ti": 12, "Td": 1, "filter": {"type": "derivative", "Tf": 0.1},
                              "form": "ideal"})"));
    EXPECT_FALSE(request_of(out.entries[1]).contains("baseline"));
    EXPECT_EQ(request_of(out.entries[2])["baseline"], Json::parse(R"({"Kp": 0.7, "form": "ideal"})"));
    const Outcome gains = read(loops(), "K,T,L,Kp,Ki,Kd,form\n2,10,3,0.5,0.05,1,\n2,10,3,0.5,0.05,1,parallel\n");
    ASSERT_EQ(gains.entries.size(), 2u);
    for (const BatchEntry& entry : gains.entries) EXPECT_EQ(request_of(entry)["baseline"]["form"], "parallel");
}

TEST(BatchReader, TodaysSettingsMayBeAProductsOwn) {
    const Outcome out =
        read(loops(),
             "name,K,T,L,product,today GAIN,today RESET,today STRUCTURE,y low,y high,u low,u high\n"
             "a,2,100,30,emerson_deltav_standard,1.2,90,\"PI action on error, D action on PV\",0,200,0,100\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    EXPECT_EQ(request_of(out.entries[0])["baseline"],
              Json::parse(R"({"settings": {"GAIN": 1.2, "RESET": 90, "STRUCTURE": "PI action on error, D action on PV"},
                              "product": "emerson_deltav_standard"})"));
    EXPECT_EQ(request_of(out.entries[0])["implement"],
              Json::parse(R"({"product": "emerson_deltav_standard", "y_span": [0, 200], "u_span": [0, 100]})"));
    // A name that ends like a unit is the product's own; one without "today" in front is not a column.
    const Outcome named =
        read(loops(), "K,T,L,product,today fKp,today tTn_ms\n2,100,30,beckhoff_fb_ctrl_pid,1.2,90000\n");
    ASSERT_FALSE(named.problem) << named.problem->detail;
    EXPECT_EQ(request_of(named.entries[0])["baseline"]["settings"], Json::parse(R"({"fKp": 1.2, "tTn_ms": 90000})"));
    EXPECT_THAT(refusal(loops(), "K,T,L,product,fKp\n2,100,30,beckhoff_fb_ctrl_pid,1.2\n"),
                HasSubstr("\"fKp\" is not a column of loops"));
}

// The new settings are for the loop's own product, and for that of the call where the line names none.
TEST(BatchReader, EachLoopMayHaveItsOwnController) {
    const Outcome out = read(loops({{"implement/product", "klipper"}, {"implement/u_span", "[0, 1]"}}),
                             "K,T [min],L,product,sample time [min],y low,y high,u low,u high\n"
                             "2,100,30,siemens_fb41_cont_c,0.01,0,200,0,100\n2,100,30,,,,,,\n2,100,30,,0.5,,,,\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 3U);
    EXPECT_EQ(request_of(out.entries[0])["implement"],
              Json::parse(R"({"product": "siemens_fb41_cont_c", "u_span": [0, 100], "sample_time": 0.01,
                              "y_span": [0, 200]})"));
    EXPECT_EQ(request_of(out.entries[1])["implement"], Json::parse(R"({"product": "klipper", "u_span": [0, 1]})"));
    EXPECT_EQ(request_of(out.entries[2])["implement"]["sample_time"], 0.5);
    for (const BatchEntry& entry : out.entries) EXPECT_FALSE(request_of(entry).contains("baseline"));
    // Today's settings by their form stay so where all loops have one product.
    const Outcome by_form = read(loops({{"implement/product", "klipper"}, {"implement/u_span", "[0, 1]"}}),
                                 "K,T,L,Kp,Ti\n2,100,30,0.5,90\n");
    EXPECT_EQ(request_of(by_form.entries[0])["baseline"], Json::parse(R"({"Kp": 0.5, "Ti": 90, "form": "ideal"})"));
    EXPECT_THAT(refusal(loops(), "K,T,L,y low,y high\n1,2,3,0,200\n"), HasSubstr("Add a column product"));
    EXPECT_THAT(refusal(loops(), "K,T [min],L,sample time [s]\n1,2,3,1\n"), HasSubstr("sample time in \"s\""));
    const Outcome wrong = read(loops(), "K,T,L,sample time\n2,100,30,often\n");
    EXPECT_EQ(problem_of(wrong.entries[0]).status, 422);
}

TEST(BatchReader, AHeadingMayHoldHalfAUnit) {
    for (const char* heading :
         {"today GAIN]", "today GAIN)", "today GAIN[", "today ]", "today's )(", "Kp]", "today Kp)"}) {
        const Outcome out =
            read(loops(), "K,T,L,product," + std::string(heading) + "\n2,100,30,emerson_deltav_standard,4\n");
        EXPECT_TRUE(out.problem || out.entries.size() == 1) << heading;
    }
}

TEST(BatchReader, TheUsersControllerIsSaidOnceForAllLoops) {
    const Outcome out = read(loops({{"implement/product", "emerson_deltav_standard"},
                                    {"implement/y_span", "[0, 200]"},
                                    {"implement/u_span", "[0,100]"}}),
                             "K,T,L,today GAIN\n2,100,30,1.2\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    const Json request = request_of(out.entries[0]);
    EXPECT_EQ(request["implement"],
              Json::parse(R"({"product": "emerson_deltav_standard", "y_span": [0, 200], "u_span": [0, 100]})"));
    EXPECT_EQ(request["baseline"]["product"], "emerson_deltav_standard");
    const auto wrong = read(loops({{"implement/product", "emerson_deltav"}}), "K,T,L\n2,100,30\n").problem;
    ASSERT_TRUE(wrong);
    EXPECT_EQ(wrong->title, "The parameters for all loops are not valid");
}

TEST(BatchReader, AFaultInTodaysSettingsSpeaksOfTheColumn) {
    const Outcome out = read(loops(), "name,K,T,L,Kp,Ti\na,2,10,3,half,12\nb,2,10,3,0.5,-12\n");
    ASSERT_EQ(out.entries.size(), 2u);
    EXPECT_THAT(problem_of(out.entries[0]).detail, HasSubstr("line 2: Kp is \"half\"; it must be a number, or empty."));
    EXPECT_THAT(problem_of(out.entries[1]).detail, HasSubstr("Ti is -12"));
    EXPECT_THAT(refusal(loops(), "K,T [min],L,Ti [s]\n1,2,3,4\n"), HasSubstr("T is in \"min\" and Ti in \"s\""));
    EXPECT_THAT(refusal(loops(), "K,T,L,today GAIN\n1,2,3,4\n"), HasSubstr("Add a column product"));
    EXPECT_THAT(refusal(loops(), "K,T,L,Kp,Kp\n1,2,3,4,5\n"), HasSubstr("two columns say \"Kp\""));
}

TEST(BatchReader, ABadLoopFailsAloneWithItsLine) {
    const Outcome out = read(loops(), "name,K,T,L\na,1,2,3\nb,x,,3\nc,1,5,2,3,4\nd,0,2,3\ne,1,2,-3\nf,1,2,3\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 6u);
    EXPECT_EQ(out.entries[1].name, "b");
    EXPECT_EQ(problem_of(out.entries[1]).detail,
              "Request 2, line 3: 2 values are not valid. The first: K is \"x\"; it must be a number.");
    EXPECT_EQ(detail_at(problem_of(out.entries[1]).errors, "/plant/T"), "T is missing; every loop needs K, T and L.");
    EXPECT_THAT(problem_of(out.entries[2]).detail, HasSubstr("line 4: It has 6 cells, the headings are 4."));
    EXPECT_THAT(detail_at(problem_of(out.entries[3]).errors, "/plant/K"), HasSubstr("K is 0"));
    EXPECT_THAT(detail_at(problem_of(out.entries[4]).errors, "/plant/L"), HasSubstr("L is -3"));
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(out.entries[5].job));
}

TEST(BatchReader, ACellInQuotesMayHaveLineBreaks) {
    const Outcome out = read(loops(),
                             "name,K,T,L\n\"TIC\n101 \"\"old\"\"\n\",1,2,3\npipe 5\",1,2,3\n\"b\r\nx\",no,2,3\n"
                             "\"open,1,2,3\nc,1,2,3\n");
    ASSERT_FALSE(out.problem) << out.problem->detail;
    ASSERT_EQ(out.entries.size(), 5u);
    EXPECT_EQ(out.entries[0].name, "TIC 101 \"old\"");
    EXPECT_EQ(out.entries[2].name, "b x");
    EXPECT_THAT(problem_of(out.entries[2]).detail, HasSubstr("Request 3, line 6: K is \"no\""));
    EXPECT_THAT(problem_of(out.entries[3]).detail, HasSubstr("Request 4, line 8: A cell begins with a quotation mark"));
    EXPECT_EQ(out.entries[4].name, "c");
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(out.entries[4].job));

    std::string body = "name,K,T,L\n\"a,1,2,3\n";
    for (int i = 0; i < 300; ++i) body += "b,1,2,3\n";
    EXPECT_EQ(read(loops(), body).entries.size(), 301u);
}

TEST(BatchReader, SaysWhichColumnsAreMissing) {
    EXPECT_THAT(refusal(loops(), "name,K,L\na,1,3\n"),
                HasSubstr("422 Line 1 must name the columns, such as name,K,T,L: T is missing."));
    EXPECT_THAT(refusal(loops(), "K\n1\n"), HasSubstr("T and L are missing"));
    EXPECT_THAT(refusal(loops(), "1,2,3\n"), HasSubstr("Line 1 has no heading of a column of loops. Put name,K,T,L"));
    EXPECT_THAT(refusal(loops(), "K,T,L,Ms\n1,2,3,4\n"), HasSubstr("\"Ms\" is not a column of loops"));
    EXPECT_THAT(refusal(loops(), "K,T,tau,L\n1,2,3,4\n"), HasSubstr("two columns say T"));
    EXPECT_THAT(refusal(loops(), "K,T [min],L [s]\n1,2,3\n"), HasSubstr("must be in the same unit"));
    EXPECT_THAT(refusal(loops(), "K,T,L\n" + std::string(70000, '1')), HasSubstr("Line 2 has more than 65536 bytes"));
}

TEST(BatchReader, RefusesOptionsThatNoLoopCanHave) {
    const std::string body = "K,T,L\n1,2,3\n";
    const Outcome out = read(loops({{"method", "simk"}}), body);
    ASSERT_TRUE(out.problem);
    EXPECT_THAT(detail_at(out.problem->errors, "/method"), HasSubstr("Did you mean simc?"));
    EXPECT_THAT(detail_at(read(loops({{"method", "robust"}, {"Ms", "0.5"}}), body).problem->errors, "/Ms"),
                HasSubstr("Ms is 0.5"));
    EXPECT_THAT(refusal(loops({{"Ms", "1.5"}, {"Ms", "1.6"}}), body), HasSubstr("\"Ms\" is given twice"));
    EXPECT_THAT(detail_at(read(loops({{"timeout_s", "0"}}), body).problem->errors, "/timeout_s"),
                HasSubstr("timeout_s is 0"));
    const Outcome nested = read(loops({{"filter/Tf_over_Td", "0.05"}, {"timeout_s", "5"}}), body);
    ASSERT_FALSE(nested.problem) << nested.problem->detail;
    EXPECT_EQ(request_of(nested.entries[0])["tune"],
              Json::parse(R"([{"filter": {"Tf_over_Td": 0.05}, "method": "robust"}])"));
    EXPECT_EQ(request_of(nested.entries[0])["timeout_s"], 5);
}

}  // namespace
}  // namespace tunewright::api
