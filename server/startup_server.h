// What answers on the port while the store is not to be had yet: its tables are brought up to date, by this process or
// another, which may take minutes. The process is alive then and not ready, and nobody who watches it ends it.
#pragma once

#include <csignal>
#include <memory>

#include "server/config.h"
#include "server/http/guard/server.h"
#include "server/store/store.h"

namespace tunewright::server {

/// Opens the store that the configuration names. Nothing where one of `signals` (blocked in every thread) came
/// meanwhile: the process is to end. Throws as open_store() does, and std::runtime_error where the port cannot be
/// opened.
std::unique_ptr<JobStore> open_behind_startup_server(const Config& config, const sigset_t& signals);

/// Opens the port that HOST:PORT names, as http::Server::listen() does.
int open_port(http::Server& server, const std::string& listen);

}  // namespace tunewright::server
