#include "engine/check/oscillation/oscillation.h"

#include "engine/check/oscillation/peak_search.h"
#include "engine/check/thresholds.h"
#include "engine/numerics/fourier.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr std::size_t kMostPeriods = 3;

/// In the time of the record, as a share of the error's whole variance.
Period in_time(Period period, const PeakSearch& search, double step) {
    period.period *= step;
    period.period_error *= step;
    period.share *= search.share_looked_at();
    return period;
}

}  // namespace

Period oscillation_of(const OscillationStudy& study, double period, double step) {
    const PeakSearch search(study.error);
    Period out = in_time(search.oscillation_about(step / period), search, step);
    out.period = period;
    return out;
}

OscillationStudy study_oscillation(const Samples& samples) {
    OscillationStudy study;
    study.error = samples.error();
    const double centre = mean(study.error), step = samples.step;
    std::vector<double> e(study.error);
    for (double& value : e) value -= centre;
    study.autocorrelation = autocorrelation(e, e.size() / 2);
    PeakSearch search(e);
    study.spectrum = search.power_over_period();
    for (double& period : study.spectrum.x) period *= step;
    std::size_t looked_at = 0;
    while (study.found.periods.size() < kMostPeriods) {
        const double f = search.frequency_of_strongest();
        if (!(f > 0)) break;
        const Period found = search.oscillation_about(f), period = in_time(found, search, step);
        if (found.share < kLeastShare) break;
        const bool told = samples.duration() >= kFewestCyclesTold * period.period;
        if (period.regularity > kRegular && told)
            study.found.periods.push_back(period);
        else if (study.found.periods.empty())
            study.strongest = period;
        search.remove(f);
        if (++looked_at >= 2 * kMostPeriods) break;
    }
    study.found.found = !study.found.periods.empty();
    if (study.found.found) study.strongest = study.found.periods.front();
    return study;
}

}  // namespace tunewright::check
