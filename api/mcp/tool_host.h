// The surroundings of the tools: a process on its own, or a service with stored jobs.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/problem.h"
#include "api/outcome.h"
#include "api/service.h"

namespace tunewright::api::mcp {

/// A job, or in a process on its own an answer that it keeps.
struct ToolJob {
    std::string id;                                ///< "": it was not kept
    std::string status;                            ///< queued, running, succeeded, failed or cancelled
    std::string request, result, error, progress;  ///< JSON; "" if there is none
};

/// The problem, as JSON, with which a call was refused or failed.
struct Refused {
    std::string problem;
};

inline Refused refused(const Problem& problem) { return {to_json(problem)}; }

using Computation = std::function<Answer(const RunControl&)>;

class ToolHost {
public:
    virtual ~ToolHost() = default;

    /// Computes when the client's turn has come, within a time limit. The id is that of the kept answer; "" if answers
    /// of calls are not kept.
    virtual std::pair<Answer, std::string> compute(const Computation& work) = 0;

    /// Runs a request as a job: with its result if it has ended soon enough.
    virtual std::variant<ToolJob, Refused> run(PreparedJob job) = 0;

    /// The job of that id, for this caller; `wait`: after its end, if that comes soon.
    virtual std::variant<ToolJob, Refused> find(const std::string& id, bool wait) = 0;

    /// {"jobs": [...]}: the newest jobs of this caller, each with its outline.
    virtual std::variant<std::string, Refused> newest() = 0;

    /// True if run() stores its job for others to see.
    virtual bool stores_jobs() const = 0;

    /// Further addresses of a job, each with a word for it; `screen` is that of the page.
    virtual std::vector<std::pair<std::string, std::string>> addresses(const std::string& id,
                                                                       const std::string& screen) const = 0;

    virtual JobLimits limits() const { return {}; }
};

/// The resource that is the whole answer of a job.
inline constexpr const char* kAnswerResource = "tunewright://answer/";

}  // namespace tunewright::api::mcp
