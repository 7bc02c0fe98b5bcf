# Three stages: the binary, the page, and what runs. Everything comes from Debian; npm's packages are pinned by the
# lock file.
FROM debian:bookworm-slim AS binary
RUN apt-get update && apt-get install -y --no-install-recommends \
        g++ make cmake ninja-build pkg-config libcpp-httplib-dev nlohmann-json3-dev libeigen3-dev libnlopt-dev \
        libsqlitecpp-dev libsqlite3-dev libpqxx-dev libpq-dev libspdlog-dev libfmt-dev libcli11-dev prometheus-cpp-dev \
        libboost-dev libssl-dev zlib1g-dev \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY CMakeLists.txt CMakePresets.json ./
COPY engine engine
COPY api api
COPY server server
RUN cmake --preset release -DTUNEWRIGHT_TESTS=OFF && cmake --build --preset release --target tunewright \
    && strip build/release/tunewright

FROM debian:bookworm-slim AS page
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates nodejs npm \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /src/web
COPY web/package.json web/package-lock.json web/.npmrc ./
RUN npm ci --no-audit --no-fund
COPY web ./
RUN npm run build

FROM debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
        libcpp-httplib0.11 libnlopt0 libsqlite3-0 libpqxx-6.4 libspdlog1.10 libfmt9 libprometheus-cpp-core1.0 \
        ca-certificates \
    && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* \
    && useradd --uid 10001 --no-create-home --shell /usr/sbin/nologin tunewright \
    && install -d -o tunewright -g tunewright /var/lib/tunewright
COPY --from=binary /src/build/release/tunewright /opt/tunewright/bin/tunewright
COPY --from=page /src/build/web /opt/tunewright/web
USER 10001
VOLUME /var/lib/tunewright
EXPOSE 8080
# The network in here is the container's own: who reaches it is decided by what is published. TUNEWRIGHT_AUTH=keys asks for more.
ENV TUNEWRIGHT_LISTEN=0.0.0.0:8080 TUNEWRIGHT_ALLOW_ANONYMOUS=true TUNEWRIGHT_STORE=sqlite:/var/lib/tunewright/jobs.db
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["/opt/tunewright/bin/tunewright", "health"]
ENTRYPOINT ["/opt/tunewright/bin/tunewright"]
CMD ["serve"]
