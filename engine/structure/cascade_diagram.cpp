#include "engine/structure/cascade_diagram.h"

namespace tunewright::structure {
namespace {

/// Plants and signals without controllers.
void add_plants(CascadeDiagram& out, const CascadePlants& plants) {
    out.diagram.add(out.valve, out.y2, plants.inner);
    out.diagram.add(plants.arrangement == Arrangement::series ? out.y2 : out.valve, out.outer_input, 1);
    out.diagram.add(out.outer_input, out.y1, plants.outer);
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
    add_plants(out, plants);
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

}  // namespace tunewright::structure
