// Answers calls while the store is not available yet: its tables are being migrated, by this process or another, which
// may take minutes. The process is then alive but not ready, so that an orchestrator does not kill it.
#pragma once

#include <csignal>
#include <memory>

#include "server/config.h"
#include "server/http/guard/server.h"
#include "server/store/store.h"

namespace tunewright::server {

/// Opens the store of the configuration. Null if one of `signals` (blocked in every thread) arrived meanwhile: the
/// process must end. Throws like open_store(), and std::runtime_error if the port cannot be opened.
std::unique_ptr<JobStore> open_behind_startup_server(const Config& config, const sigset_t& signals);

/// Opens the port of HOST:PORT, like http::Server::listen().
int open_port(http::Server& server, const std::string& listen);

}  // namespace tunewright::server
