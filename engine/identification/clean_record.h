// A record made fit for computing: rows in time order, u as a list of changes, everything dimensionless.
#pragma once

#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/record.h"

namespace tunewright {

/// Units of the dimensionless record: t = t_origin + t_scale t', u = u_rest + u_scale v, y = y_origin + y_scale y'.
struct RecordScale {
    double t_origin = 0, t_scale = 1;
    double u_rest = 0, u_scale = 1;
    double y_origin = 0, y_scale = 1;
};

/// Dimensionless samples and input. The input v is 0 before the first sample and v_level[j] from v_time[j] on; v_time
/// ascends strictly, from 0. Sample times ascend from 0, equal times may repeat (each row's y is data). |v| <= 1, y
/// spans 1, the record lasts 1.
struct CleanRecord {
    std::vector<double> t, y;
    std::vector<double> v_time, v_level;
    std::optional<double> y_rest;             ///< y0 where the user gave it
    bool u0_given = false;                    ///< then the level of rest is known, also for integrating plants
    RecordKind kind = RecordKind::automatic;  ///< as given
    RecordScale scale;
    int dropped = 0;  ///< rows left out
    int u_only = 0;   ///< rows whose y is no number: their u still counts

    int samples() const { return static_cast<int>(t.size()); }
    int changes() const { return static_cast<int>(v_time.size()); }
    /// From the first change of u to the end.
    double response_time() const { return v_time.empty() ? 0 : t.back() - v_time.front(); }
};

inline constexpr int kFewestSamples = 8;

/// Drops rows that are no numbers or run backward in time, merges rows of equal time (the last u counts, every y is
/// data) and scales. Errors: invalid_argument for columns of unequal length, a non-finite u0 or y0, or times mostly out
/// of order; not_identifiable for fewer than 8 usable samples, a constant u, a constant y, or a record without
/// duration.
Expected<CleanRecord> clean_record(const Record& record);

/// A record of at most about `most` samples with the same input, denser after the large changes of u: for coarse
/// searches. An input of very many changes is averaged over blocks.
CleanRecord thin_out(const CleanRecord& record, int most);

}  // namespace tunewright
