#include <memory>
#include <utility>

#include "engine/number_text.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/model/range_model.h"

namespace tunewright::range {
namespace {

constexpr int kPoints = 5;

class BranchModel : public RangeModel {
public:
    explicit BranchModel(std::shared_ptr<const SteadyBranch> branch) : branch_(std::move(branch)) {
        low_ = branch_->low();
        high_ = branch_->high();
        for (int k = 0; k < kPoints; ++k) points_.push_back(low_ + (high_ - low_) * k / (kPoints - 1));
        points_.back() = high_;
        stated_ =
            "At every place the plant is the exact linearisation of the equations about their steady state there.";
        for (const Fold& fold : branch_->input_folds())
            warnings_.push_back(
                {"input-folds",
                 "The input turns back along the steady states at " + branch_->scheduling_name() + " = " +
                     text(fold.state.at, 6) + " (" + branch_->range().plant.input.name + " = " + text(fold.state.u, 6) +
                     "): on one side of it the plant has a pole in the right half-plane and only the loop holds it."});
    }

    Expected<PlaceModel> at(double place) const override {
        const auto state = branch_->at(place);
        if (!state) return state.error();
        auto linear = LinearPlant::make(branch_->linearised(*state));
        if (!linear)
            return Error{linear.error().kind, "plant/equations",
                         "The linearisation at " + branch_->scheduling_name() + " = " + text(place, 6) +
                             " cannot be worked with. " + linear.error().message};
        PlaceModel model{.at = place, .nominal = std::move(*linear), .members = {}, .measured = {}};
        model.u = state->u;
        model.y = state->y;
        return model;
    }

private:
    std::shared_ptr<const SteadyBranch> branch_;
};

}  // namespace

Expected<std::shared_ptr<const RangeModel>> model_of_branch(std::shared_ptr<const SteadyBranch> branch) {
    std::shared_ptr<const RangeModel> model = std::make_shared<BranchModel>(std::move(branch));
    for (const double at : model->points())
        if (const auto place = model->at(at); !place) return place.error();
    return model;
}

}  // namespace tunewright::range
