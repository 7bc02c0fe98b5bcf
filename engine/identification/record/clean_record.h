// A record made fit for computing: rows in time order, u as a list of changes, everything dimensionless.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/record/record.h"

namespace tunewright {

/// Units of the dimensionless record: t = t_origin + t_scale t', u = u_rest + u_scale v, y = y_origin + y_scale y'.
struct RecordScale {
    double t_origin = 0, t_scale = 1;
    double u_rest = 0, u_scale = 1;
    double y_origin = 0, y_scale = 1;
};

/// What was done to the rows, by their numbers: lines of the file, or indices from 0 where there is none.
struct Cleaning {
    bool from_file = false;
    int without_time = 0;                   ///< left out: no time, or no u yet
    int backward = 0, first_backward = 0;   ///< left out: a time before the rows above
    int early_stamps = 0, first_early = 0;  ///< left out: a time far ahead, from which the next rows run backward
    bool reversed = false;                  ///< the rows ran from the newest to the oldest
    int repeated = 0, first_repeated = 0;   ///< rows with the time of the row above
    bool spread = false;                    ///< and they were spread over the time until the next: a coarse clock
    int missing_u = 0;                      ///< u was held
    int missing_y = 0;                      ///< u of the row was used
    double hole_from = 0, hole_to = 0;      ///< the longest time without y because of that, record's unit
    std::vector<int> spikes;                ///< left out: readings of y that are false plainly (record_rows.h)
    std::vector<double> spike_times;        ///< of the same, record's unit
    int unread = 0;                         ///< left out: first rows of before the logger's first reading
    int silent = 0;                         ///< left out: first rows of before the sensor's first reading
    int late_moves = 0;                     ///< left out: changes of u that no sample follows
    int limited_u = 0;                      ///< rows in which u was cut to its limits
};

/// "line 12" or "row 12".
std::string row_text(const Cleaning& cleaning, int row);

/// What is known of a whole record, whichever of its samples are looked at.
struct RecordFacts {
    std::optional<double> y_rest;             ///< y0 where the user gave it
    bool u0_given = false;                    ///< then the level of rest is known, also for integrating plants
    bool moved_at_first_row = false;          ///< a controller was switched on there: the first u is no level of rest
    RecordKind kind = RecordKind::automatic;  ///< as given
    RecordScale scale;
    Cleaning cleaning;
    int dropped = 0;  ///< rows whose y is not used
    int u_only = 0;   ///< of them, rows whose u counts
    bool moved_between_rows =
        false;                ///< each change of u was put midway between the row that shows it and the one before
    int moves_placed = 0;     ///< changes of u that were put at rows that are missing (fit/record_repair.h)
    int switches_placed = 0;  ///< a relay's switches that were put between rows (fit/record_repair.h)
    /// No change of u was recorded: each was put into the middle of the missing rows before it, so long at least.
    double moves_unseen = 0;
    /// The rows may show the changes of u late: together they may lie anywhere within this length about where they
    /// stand (fit/move_times.h).
    double moved_within = 0;
};

/// A further measured input as changes, dimensionless: at rest at 0, level[j] from time[j] on; |level| <= 1. Times
/// ascend strictly from 0.
struct FurtherSteps {
    std::string name;
    std::vector<double> time, level;
    double scale = 1;  ///< of a level, in the input's unit
};

/// Dimensionless samples and input. The input v is 0 before the first sample and v_level[j] from v_time[j] on; v_time
/// ascends strictly, from 0. Sample times ascend from 0, equal times may repeat (each row's y is data). |v| <= 1, y
/// spans 1, the record lasts 1.
struct CleanRecord : RecordFacts {
    std::vector<double> t, y;
    std::vector<int> row;  ///< of each sample, as Cleaning numbers them; empty where samples were chosen or averaged
    std::vector<double> v_time, v_level;
    /// Length of time within which each change of u was estimated (fit/move_times.h); 0: its time is known.
    /// Empty: all are known.
    std::vector<double> v_open = {};
    std::vector<FurtherSteps> d = {};  ///< those that move

    int samples() const { return static_cast<int>(t.size()); }
    int changes() const { return static_cast<int>(v_time.size()); }
    /// From the first change of u to the end.
    double response_time() const { return v_time.empty() ? 0 : t.back() - v_time.front(); }
};

inline constexpr int kMinSamples = 8;

/// Puts rows in order: a record from newest to oldest is turned round, a row whose time is before the rows above or far
/// ahead of those below is left out, rows of equal time are kept (the last u counts, every y is data) or, where a third
/// of all are such, spread until the next time. A missing u is held, a missing or plainly false y left out. Then it
/// scales. Errors: invalid_argument for columns of unequal length, a non-finite u0 or y0, or times mostly out
/// of order; not_identifiable for fewer than 8 usable samples, a constant u, a constant y, or a record without
/// duration.
Expected<CleanRecord> clean_record(const Record& record);

/// The times from one sample to the next, equal times left out.
std::vector<double> spacings(const CleanRecord& record);

/// Their median; 0 where there is none.
double usual_spacing(const CleanRecord& record);

/// A spacing that differs from the usual one by more than this share of it is another spacing, not jitter of the clock.
inline constexpr double kOffSpacing = 0.1;

/// Whether more than a fifth of the times from one sample to the next, equal times included, differ from the usual one.
bool unevenly_spaced(const CleanRecord& record);

/// A record of at most about `max` samples with the same input, denser after the large changes of u: for coarse
/// searches. An input of very many changes is averaged over blocks.
CleanRecord thin_out(const CleanRecord& record, int max);

/// Without the samples of these indices, which are noted as false readings. Of a whole record.
CleanRecord without_samples(CleanRecord record, const std::vector<std::size_t>& indices);

/// Every second, third, ... sample, so that at most `max` are left, with the input as it is.
CleanRecord every_few(const CleanRecord& record, int max);

/// The record's beginning, `fraction` of its length, again of length 1.
CleanRecord first_part(const CleanRecord& record, double fraction);

/// At most `max` samples, each the mean of as many neighbours: of a record so dense that a block is nothing beside the
/// response, it says the same, noise averaged. The input stays as it is.
CleanRecord block_means(const CleanRecord& record, int max);

/// The same, with the means of the input over as many equal stretches where it changes more often than that: a plant
/// that is slow beside a block answers the mean as it does the moves.
CleanRecord condensed(const CleanRecord& record, int max);

}  // namespace tunewright
