// Requests about a whole operating range: points or equations, and the abilities of the user's controller.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/contract/request.h"
#include "engine/range/experiments.h"
#include "engine/request/range/ask_range.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/filter_rule.h"

namespace tunewright::api {

struct GivenScheduling {
    std::optional<std::string> name, unit;
};

/// One point as sent: a plant or a record.
struct GivenRangePoint {
    double at = 0;
    std::optional<PlantModel> plant;
    std::optional<GivenRecord> record;
};

/// The path of the equations through their steady states.
struct GivenWay {
    range::Along along = range::Along::output;
    std::optional<std::string> parameter;
    double from = 0, to = 0;
    bool hold_output = true;
};

/// A row as sent; without a Tf it gets 0.1 Td.
struct GivenRow {
    double at = 0, Kp = 0, Ti = 0, Td = 0;
    std::optional<double> Tf;
    double b = 1;
};

struct ScheduleWish {
    ControllerKind controller = ControllerKind::PID;
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;
    RobustFilterOptions filter;
    range::Aim aim = range::Aim::worst;
    double allowance = 0.05;
    std::optional<int> rows;
    Interpolation interpolation = Interpolation::linear_in_gains;
    double hysteresis = 0.02;
    range::Between between = range::Between::parameters;
    double b = 1;
    std::optional<std::vector<GivenRow>> given;
};

/// The members that describe the range in every request about one.
struct RangeSubject {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;  ///< equations
    std::optional<GivenWay> way;      ///< `range` of the request
    std::shared_ptr<const range::SteadyBranch> branch;
};

struct RangeRequest : RangeSubject, JobTerms {
    std::optional<GivenScheduling> scheduling;
    std::optional<std::vector<GivenRangePoint>> points;
    IdentifyQuestion identify;
    std::optional<bool> over_region;
    ScheduleWish schedule;
    bool runs = true;
    RangeQuestion question;         ///< the whole question for the engine
    std::vector<ReadRecord> reads;  ///< of the points, in their order; the records themselves are in `question`
};

/// A job's request about a range, with the terms on which it is run; its checks include those of the engine for points
/// and equations.
const Description<RangeRequest>& range_request_contract();

/// True if a request of POST /v1/jobs is about a range.
bool is_range_request(const Json& request);

/// Follows the steady states of `plant` along `way`; faults go to the reader.
void follow_way(RangeSubject& subject, Reader& reader);

const Description<GivenWay>& way_contract();

const Description<GivenRow>& given_row_contract();
/// Checks that the rows ascend and that all Kp have one sign; faults at the row.
void check_given_rows(const std::vector<GivenRow>& rows, Reader& reader);
std::vector<ScheduleRow> rows_of(const std::vector<GivenRow>& given);

const Description<ScheduleWish>& schedule_wish_contract();
range::RangeOptions options_of(const ScheduleWish& wish);
/// The rows that were given, if any.
std::vector<ScheduleRow> rows_of(const ScheduleWish& wish);
/// The codec of the interpolation; schedules are written with it too.
Codec<Interpolation> interpolation_word();

}  // namespace tunewright::api
