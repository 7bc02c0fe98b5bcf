#include "engine/structure/cascade_diagram.h"

#include <memory>
#include <utility>

#include "engine/blocks/diagram_stability.h"
#include "engine/structure/drawing/view.h"

namespace tunewright::structure {
namespace {

/// Plants and signals without controllers. An outer plant that is in no loop is left out: its poles are not the loop's.
void add_plants(CascadeDiagram& out, const CascadePlants& plants, bool with_outer = true) {
    out.diagram.add(out.valve, out.y2, plants.inner);
    out.diagram.add(plants.arrangement == Arrangement::series ? out.y2 : out.valve, out.outer_input, 1);
    if (with_outer) out.diagram.add(out.outer_input, out.y1, plants.outer);
}

StructureView view_of(const std::string& of, const CascadeDiagram& all) {
    return {.of = of,
            .diagram = all.diagram,
            .inputs = {{"setpoint", all.r1}, {"outer_load", all.outer_input}, {"inner_load", all.valve}},
            .outputs = {{"y1", all.y1}, {"y2", all.y2}, {"u", all.valve}},
            .curves = {}};
}

Error at(const char* where, Error error) {
    error.where = where;
    return error;
}

}  // namespace

Expected<CascadeDiagram> cascade_diagram(const CascadePlants& plants, const IdealPid& inner, const IdealPid* outer) {
    CascadeDiagram out;
    BlockDiagram& diagram = out.diagram;
    out.y1 = diagram.add_signal();
    out.y2 = diagram.add_signal();
    out.outer_input = diagram.add_signal();
    const auto second = add_pid(diagram, to_parallel(inner), out.y2);
    if (!second) return at("inner/controller", second.error());
    out.valve = second->output;
    out.r2 = second->error;
    add_plants(out, plants, outer != nullptr);
    if (outer == nullptr) return out;
    const auto first = add_pid(diagram, to_parallel(*outer), out.y1);
    if (!first) return at("outer/controller", first.error());
    out.r1 = first->error;
    out.r2 = first->output;
    diagram.add(first->output, second->error, 1);
    return out;
}

Expected<CascadeDiagram> single_diagram(const CascadePlants& plants, const IdealPid& controller) {
    CascadeDiagram out;
    out.y1 = out.diagram.add_signal();
    out.y2 = out.diagram.add_signal();
    out.outer_input = out.diagram.add_signal();
    const auto pid = add_pid(out.diagram, to_parallel(controller), out.y1);
    if (!pid) return at("outer/controller", pid.error());
    out.valve = out.r2 = pid->output;
    out.r1 = pid->error;
    add_plants(out, plants);
    return out;
}

Expected<StructureView> cascade_view(const std::string& of, const CascadePlants& plants,
                                     const CascadeControllers& controllers, const CascadeDesign* limits) {
    const auto all = cascade_diagram(plants, controllers.inner, &controllers.outer);
    if (!all) return all.error();
    auto inner = cascade_diagram(plants, controllers.inner, nullptr);
    if (!count_unstable_poles(inner->diagram).stable())
        return Error{ErrorKind::unsupported, "", "The inner loop by itself is not stable."};
    StructureView out = view_of(of, *all);
    std::optional<double> Ms_inner, Ms_outer, Ms_valve;
    if (limits != nullptr) {
        Ms_inner = limits->inner.Ms;
        Ms_outer = limits->outer.Ms;
        Ms_valve = limits->valve_limit();
    }
    const auto own = std::make_shared<const BlockDiagram>(std::move(inner->diagram));
    const auto whole = std::make_shared<const BlockDiagram>(all->diagram);
    out.curves = {sensitivity_at("inner", own, inner->valve, Ms_inner),
                  sensitivity_at("outer", whole, all->r2, Ms_outer),
                  sensitivity_at("valve", whole, all->valve, Ms_valve)};
    return out;
}

Expected<StructureView> single_view(const CascadePlants& plants, const IdealPid& controller) {
    const auto all = single_diagram(plants, controller);
    if (!all) return all.error();
    StructureView out = view_of("single", *all);
    out.curves = {sensitivity_at("valve", std::make_shared<const BlockDiagram>(all->diagram), all->valve, {})};
    return out;
}

}  // namespace tunewright::structure
