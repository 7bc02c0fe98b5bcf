#include "engine/check/valve/valve_model.h"

#include <array>
#include <cmath>

namespace tunewright::check {
namespace {

constexpr int kBands = 18;
constexpr double kLeastBand = 0.05, kMostBand = 1.05;         // of the span
constexpr std::array<double, 4> kJumps = {0, 0.33, 0.67, 1};  // of the band

int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

double Valve::move(double u) {
    if (model_.kind == ValveModel::Kind::he)
        move_he(u);
    else
        move_kano(u);
    before_ = u;
    return position_;
}

void Valve::move_he(double u) {
    if (u == before_) return;
    const double force = stored_ + (u - before_);
    stored_ = force;
    if (std::abs(force) <= 0.5 * (model_.band + model_.jump)) return;
    stored_ = std::copysign(0.5 * (model_.band - model_.jump), force);
    position_ += force - stored_;
}

void Valve::move_kano(double u) {
    const int now = sign(u - before_);
    if (now != last_ && !stopped_) {
        stopped_ = true;
        stopped_at_ = before_;
    }
    if (stopped_) {
        const double ahead = direction_ * (u - stopped_at_);
        if (-ahead > model_.band) {
            direction_ = -direction_;
            stopped_ = false;
        } else if (ahead > model_.jump) {
            stopped_ = false;
        }
    }
    if (!stopped_) position_ = u - direction_ * 0.5 * (model_.band - model_.jump);
    last_ = now;
}

std::vector<double> valve_position(std::span<const double> output, const ValveModel& valve) {
    std::vector<double> position;
    position.reserve(output.size());
    if (output.empty()) return position;
    Valve moved(valve, output[0]);
    for (const double u : output) position.push_back(moved.move(u));
    return position;
}

std::vector<ValveModel> valve_candidates(double span) {
    std::vector<ValveModel> all;
    for (const auto kind : {ValveModel::Kind::he, ValveModel::Kind::kano})
        for (int i = 0; i < kBands; ++i)
            for (const double jump : kJumps) {
                if (kind == ValveModel::Kind::kano && jump == 0) continue;
                const double band = span * kLeastBand * std::pow(kMostBand / kLeastBand, double(i) / (kBands - 1));
                all.push_back({kind, band, jump * band});
            }
    return all;
}

}  // namespace tunewright::check
