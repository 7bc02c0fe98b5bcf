// One allocation that fails, anywhere in the store or in reading a request: no answer is wrong, no reported result is
// lost, and the next call works.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "api/service.h"
#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/faulty/bookkeeper.h"
#include "tests/server/store/faulty/memory.h"
#include "tests/server/store/store_file.h"

namespace tunewright::server {
namespace {

const int kPoints = fault_points(1000);

std::string text_of(const std::variant<api::PreparedJob, api::Problem>& read) {
    if (const auto* job = std::get_if<api::PreparedJob>(&read)) return job->request_hash + job->request_json;
    return api::refusal(std::get<api::Problem>(read)).body;
}

/// Requests with every kind of plant, a record as rows and as CSV, and faults of each kind.
std::vector<std::string> requests() {
    std::string csv = "time (s),u,y\\n", rows_u = "0", rows_y = "0";
    for (int i = 0; i < 40; ++i) {
        const std::string u = i < 5 ? "0" : "1", y = std::to_string(i < 8 ? 0 : i - 8);
        csv += std::to_string(i) + "," + u + "," + y + "\\n";
        rows_u += "," + u;
        rows_y += "," + y;
    }
    return {
        R"({"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"robust","Ms":1.4}],"units":{"time":"s"}})",
        R"({"plant":{"type":"tf","num":[1,2],"den":[1,3,3,1],"L":0.5},"tune":[{"method":"all"}],"implement":{"product":"klipper","u_span":[0,100]}})",
        R"j({"plant":"2 e^(-3s)/(10s+1)","tune":[{"method":"simc"}],"evaluate":{"actuator":{"min":-1,"max":2}}})j",
        R"({"plant":{"type":"equations","states":{"x":1},"equations":{"x":"u - x^2"},"input":"u","output":"x"},"tune":[{"method":"robust"}]})",
        R"({"record":{"csv":")" + csv + R"("},"tune":[{"method":"robust"}]})",
        R"({"record":{"dt":1,"u":[)" + rows_u + R"(],"y":[)" + rows_y + R"(]},"tune":[{"method":"robust"}]})",
        R"({"plant":{"type":"fopdt","K":0,"T":-1},"tune":[{"method":"nobody"}],"other":[1,2,{"three":3}]})",
        R"({"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"robust",]})",
    };
}

enum class Read { right, refused, ended, wrong, crashed };

/// In a separate process. `ended`: std::terminate, which a destructor of the JSON library may call because it
/// allocates.
Read read_with_failure(const std::string& request, std::int64_t number, const std::string& right) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::set_terminate([] { ::_exit(static_cast<int>(Read::ended)); });
        Read read = Read::refused;
        try {
            std::optional<FailingAllocation> one(number);
            const auto outcome = api::prepare_job(request);
            one.reset();
            read = text_of(outcome) == right ? Read::right : Read::wrong;
        } catch (const std::bad_alloc&) {
        }
        ::_exit(static_cast<int>(read));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? static_cast<Read>(WEXITSTATUS(status)) : Read::crashed;
}

TEST(FailingMemory, ReadsNoRequestWrongly) {
    if (!can_fail_allocations()) GTEST_SKIP() << "a sanitizer has operator new";
    int points = 0, ended = 0;
    for (const std::string& request : requests()) {
        const std::string right = text_of(api::prepare_job(request));
        std::int64_t all = 0;
        {
            const FailingAllocation none(-1);
            (void)api::prepare_job(request);
            all = none.calls();
        }
        const std::int64_t step =
            std::max<std::int64_t>(1, all * static_cast<std::int64_t>(requests().size()) / kPoints / 2);
        for (std::int64_t number = 0; number < all; number += step, ++points) {
            const Read read = read_with_failure(request, number, right);
            ended += read == Read::ended;
            EXPECT_TRUE(read == Read::right || read == Read::refused || read == Read::ended)
                << static_cast<int>(read) << " at allocation " << number << " of " << request;
        }
    }
    EXPECT_GE(points, kPoints);
    EXPECT_LE(ended, points / 20);
}

TEST(FailingMemory, LosesNoJobOfAStore) {
    if (!can_fail_allocations()) GTEST_SKIP() << "a sanitizer has operator new";
    take_sqlite_memory();
    constexpr int jobs = 6;
    std::int64_t all = 1;
    int points = 0;
    for (std::int64_t number = 0; number < all; number += std::max<std::int64_t>(1, all / kPoints), ++points) {
        const TemporaryFolder folder(scratch());
        std::map<std::string, JobStatus> there;
        {
            const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
            store->recover(1, 10, "{}");
            Bookkeeper keeper(*store);
            {
                const FailingAllocation one(number);
                for (int i = 0; i < jobs; ++i) keeper.live(i);
                all = std::max(all, one.calls());
            }
            keeper.live(jobs + 1);
            EXPECT_TRUE(keeper.there().contains("job" + std::to_string(jobs + 1))) << number;
            there = keeper.there();
        }
        const auto again = open_sqlite_store(folder.file(), SchemaSteps::take);
        expect_kept(*again, there, "at allocation " + std::to_string(number));
    }
    EXPECT_GE(points, kPoints);
}

}  // namespace
}  // namespace tunewright::server
