// Records that contradict themselves are refused, with the place of the contradiction.
#include <gmock/gmock.h>

#include <variant>

#include "tests/api/support.h"

namespace tunewright::api {
namespace {

struct BadRecord {
    const char* name;
    std::string record;
    const char* pointer;
    const char* sentence;
};

TEST(BadRecords, AreRefusedWhereTheyContradictThemselves) {
    const BadRecord all[] = {
        {"PartAfterTheStepThatIsGiven", R"({"dt": 1, "y": [0, 0, 1, 2, 3], "u_step": [0, 5], "from": 2})",
         "/record/from", "u steps at the first row by u_step, among the rows before 2, which from leaves out"},
        {"PartOfACsvAfterTheStepThatIsGiven", R"({"csv": "t,y\n0,0\n1,0\n2,1\n3,2\n", "u_step": [0, 5], "from": 2})",
         "/record/from", "u steps at the first row by u_step"},
        {"U0OfRowsThatAreLeftOut", R"({"dt": 1, "u": [5, 5, 5, 5], "y": [0, 0, 1, 2], "u0": 0, "from": 2})",
         "/record/u0", "u0 is 0 and u is 5 at the end of the rows before 2"},
        {"StepBesideURead", R"({"csv": "t,u,y\n0,0,0\n1,0,0\n2,1,1\n3,1,2\n", "u_step": [0, 5]})", "/record/u_step",
         "the file has \"u\". Remove u_step"},
        {"DisturbanceThatIsU",
         R"({"dt": 1, "u": [0, 1, 1, 3], "y": [0, 0, 1, 2],
                                   "d": [{"name": "q", "values": [7, 9, 9, 13]}]})",
         "/record/d/0", "\"q\" moves as u does in every row"},
        {"DisturbanceThatIsAnother",
         R"({"dt": 1, "u": [0, 1, 1, 3], "y": [0, 0, 1, 2],
                                   "d": [{"name": "p", "values": [7, 8, 9, 13]}, {"name": "q", "values": [-7, -8, -9, -13]}]})",
         "/record/d/1", "\"q\" moves as \"p\" does in every row"},
        {"DisturbanceOfACsvThatIsY",
         R"({"csv": "t,u,y,q\n0,0,0,1\n1,0,0,1\n2,1,1,2\n3,1,2,3\n", "columns": {"d": ["q"]}})", "/record/columns/d/0",
         "\"q\" moves as y does in every row"},
        {"DisturbancesOfOneName",
         R"({"dt": 1, "u": [0, 1, 1, 3], "y": [0, 0, 1, 2],
                                   "d": [{"name": "q", "values": [7, 8, 9, 1]}, {"name": "q", "values": [1, 8, 3, 3]}]})",
         "/record/d/1/name", "must be different"},
        {"MessageLogColumnByNumber",
         R"({"csv": "FMT,1,9,A,Qf,TimeUS,X,Y\n)" +
             [] {
                 std::string rows;
                 for (int k = 0; k < 9; ++k) rows += "A," + std::to_string(k) + ",1,2\\n";
                 return rows;
             }() +
             R"(", "columns": {"u": 2, "d": [3]}})",
         "/record/columns/u", "u is column 2"}};
    for (const BadRecord& bad : all) {
        const auto answer = prepare_job(R"({"record": )" + bad.record + "}");
        const auto* problem = std::get_if<Problem>(&answer);
        ASSERT_NE(problem, nullptr) << bad.name << " was accepted";
        EXPECT_EQ(problem->status, 422) << bad.name;
        EXPECT_THAT(detail_at(problem->errors, bad.pointer), testing::HasSubstr(bad.sentence)) << bad.name;
    }
}

}  // namespace
}  // namespace tunewright::api
