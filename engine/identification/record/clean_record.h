// A record prepared for computation: rows in time order, u as a list of changes, everything dimensionless.
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

/// Changes made to the rows, by their numbers: lines of the file, or indices from 0 without a file.
struct Cleaning {
    bool from_file = false;
    int without_time = 0;                   ///< removed: no time, or no u yet
    int backward = 0, first_backward = 0;   ///< removed: a time before that of the rows above
    int early_stamps = 0, first_early = 0;  ///< removed: a time far ahead, after which the next rows run backward
    bool reversed = false;                  ///< the rows ran from the newest to the oldest
    int repeated = 0, first_repeated = 0;   ///< rows with the time of the row above
    bool spread = false;                    ///< they were spread over the time until the next one: a coarse clock
    int missing_u = 0;                      ///< u kept its previous value
    int missing_y = 0;                      ///< only the u of the row was used
    double hole_from = 0, hole_to = 0;      ///< the longest time without y for that reason, record's unit
    std::vector<int> spikes;                ///< removed: clearly false readings of y (record_rows.h)
    std::vector<double> spike_times;        ///< their times, record's unit
    int unread = 0;                         ///< removed: first rows before the logger's first reading
    int silent = 0;                         ///< removed: first rows before the sensor's first reading
    int late_moves = 0;                     ///< removed: changes of u that no sample follows
    int limited_u = 0;                      ///< rows in which u was limited
};

/// "line 12" or "row 12".
std::string row_text(const Cleaning& cleaning, int row);

/// Backlash between u and the plant: positions follow u, but the first `width` after each change of direction is lost.
struct Play {
    double width = 0;  ///< dimensionless, above 0
    double ahead = 0;  ///< share of it that lies in the way of the first move, 0 to 1
};

/// Facts of a whole record, independent of the choice of samples.
struct RecordFacts {
    std::optional<double> y_rest;             ///< y0 where the user gave it
    bool u0_given = false;                    ///< the level of rest is known, also for integrating plants
    bool moved_at_first_row = false;          ///< a controller was switched on there: the first u is not a level of
                                              ///< rest
    RecordKind kind = RecordKind::automatic;  ///< as given
    RecordScale scale;
    Cleaning cleaning;
    int dropped = 0;  ///< rows whose y is not used
    int u_only = 0;   ///< of these, rows whose u counts
    bool moved_between_rows =
        false;                ///< each change of u was put midway between the row that shows it and the previous row
    int moves_placed = 0;     ///< changes of u that were placed at missing rows (search/record_repair.h)
    int switches_placed = 0;  ///< a relay's switches that were placed between rows (search/record_repair.h)
    /// No change of u was recorded: each was put into the middle of the missing rows before it, whose length is at
    /// least this.
    double moves_unseen = 0;
    /// The rows may show the changes of u late: together they may lie anywhere within an interval of this length around
    /// their recorded times (search/move_times.h).
    double moved_within = 0;
    std::optional<Play> play;  ///< the input is behind a play (search/play.h)
};

/// A further measured input as changes, dimensionless: at rest at 0, level[j] from time[j] on; |level| <= 1. Times are
/// strictly ascending from 0.
struct FurtherSteps {
    std::string name;
    std::vector<double> time, level;
    double scale = 1;  ///< scale of a level, in the input's unit
};

/// Dimensionless samples and input. The input v is 0 before the first sample and v_level[j] from v_time[j] on; v_time
/// ascends strictly, from 0. Sample times ascend from 0, equal times may repeat (each row's y is data). |v| <= 1, y
/// spans 1, the record lasts 1.
struct CleanRecord : RecordFacts {
    std::vector<double> t, y;
    std::vector<int> row;  ///< number of each sample's row, as in Cleaning; empty if samples were chosen or averaged
    std::vector<double> v_time, v_level;
    /// Length of time within which each change of u was estimated (search/move_times.h); 0: its time is known.
    /// Empty: all are known.
    std::vector<double> v_open = {};
    std::vector<FurtherSteps> d = {};  ///< only inputs that move
    /// With a play: v itself, while v_level are the positions behind it. Otherwise empty.
    std::vector<double> v_recorded = {};

    int samples() const { return static_cast<int>(t.size()); }
    int changes() const { return static_cast<int>(v_time.size()); }
    /// From the first change of u to the end.
    double response_time() const { return v_time.empty() ? 0 : t.back() - v_time.front(); }
};

inline constexpr int kMinSamples = 8;

/// Puts rows in order: a record from newest to oldest is reversed; a row whose time is before the rows above or far
/// ahead of those below is removed; rows of equal time are kept (the last u counts, every y is data) or, if they are a
/// third of all, spread until the next time. A missing u keeps its previous value; a missing or clearly false y is
/// removed. Then the record is scaled. Errors: invalid_argument for columns of unequal length, a non-finite u0 or y0,
/// or times mostly out of order; not_identifiable for fewer than 8 usable samples, a constant u, a constant y, or a
/// record without duration.
Expected<CleanRecord> clean_record(const Record& record);

/// The times from one sample to the next, without equal times.
std::vector<double> spacings(const CleanRecord& record);

/// Their median; 0 if there is none.
double usual_spacing(const CleanRecord& record);

/// A spacing that differs from the usual one by more than this share is a different spacing, not jitter of the clock.
inline constexpr double kOffSpacing = 0.1;

/// True if more than a fifth of the times from one sample to the next, including equal times, differ from the usual
/// one.
bool unevenly_spaced(const CleanRecord& record);

/// A record of at most about `max` samples with the same input, denser after the large changes of u: for coarse
/// searches. An input of very many changes is averaged over blocks.
CleanRecord thin_out(const CleanRecord& record, int max);

/// The record without the samples of these indices, which are noted as false readings. Only for a whole record.
CleanRecord without_samples(CleanRecord record, const std::vector<std::size_t>& indices);

/// Every second, third, ... sample, so that at most `max` remain, with the input unchanged.
CleanRecord every_few(const CleanRecord& record, int max);

/// The record's beginning, `fraction` of its length, again of length 1.
CleanRecord first_part(const CleanRecord& record, double fraction);

/// At most `max` samples, each the mean of an equal number of neighbours: if a block is much shorter than the response,
/// this contains the same information with averaged noise. The input is not changed.
CleanRecord block_means(const CleanRecord& record, int max);

/// The same; if the input changes more often than that, it is averaged over the same number of equal intervals: a plant
/// that is slow compared with a block responds to the mean as to the moves.
CleanRecord condensed(const CleanRecord& record, int max);

}  // namespace tunewright
