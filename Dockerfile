# Three stages: the binary, the page, and what runs. Everything comes from Debian; npm's packages are pinned by the
# lock file. What the first two install is in script/bootstrap alone, and is installed before the sources come, so that
# a change of theirs leaves it as it is. The last installs the libraries that the binary names.
ARG DEBIAN=trixie
FROM debian:$DEBIAN-slim AS binary
WORKDIR /src
COPY script/bootstrap script/bootstrap
RUN script/bootstrap build
COPY deploy/container deploy/container
RUN deploy/container/sbom '*-dev' >build-packages.txt
COPY CMakeLists.txt CMakePresets.json ./
COPY engine engine
COPY api api
COPY server server
COPY bench/problems/problems.json bench/problems/
RUN cmake --preset release -DTUNEWRIGHT_TESTS=OFF && cmake --build --preset release --target tunewright \
    && strip build/release/tunewright && deploy/container/libraries build/release/tunewright >libraries.txt

FROM debian:$DEBIAN-slim AS page
WORKDIR /src
COPY script/bootstrap script/bootstrap
COPY web/package.json web/package-lock.json web/.npmrc web/
RUN script/bootstrap page
COPY web web
COPY docs docs
COPY bench/problems/problems.json bench/problems/
RUN cd web && npm run build && npm ls --omit=dev >../page-packages.txt

FROM debian:$DEBIAN-slim
COPY --from=binary /src/libraries.txt /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates $(cat /tmp/libraries.txt) \
    && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* \
    && useradd --uid 10001 --no-create-home --shell /usr/sbin/nologin tunewright \
    && install -d -o tunewright -g tunewright /var/lib/tunewright
COPY LICENSE /opt/tunewright/LICENSE
COPY --from=page /src/page-packages.txt /tmp/
COPY --from=binary /src/build-packages.txt /src/deploy/container/sbom /tmp/
RUN { echo "# Debian packages of this image"; /tmp/sbom '*'; \
      echo "# Debian packages that the program was built with; of some, headers are compiled into it"; \
      cat /tmp/build-packages.txt; \
      echo "# npm packages in the page"; cat /tmp/page-packages.txt; } >/opt/tunewright/SBOM.txt \
    && rm /tmp/*
COPY --from=page /src/build/web /opt/tunewright/web
COPY --from=binary /src/build/release/tunewright /opt/tunewright/bin/tunewright
# The version is CMakeLists.txt's. Whoever builds from sources of his own says where they are.
ARG VERSION=1.0.0
ARG SOURCE=https://tunewright.example/source
LABEL org.opencontainers.image.title="Tunewright" \
      org.opencontainers.image.description="Tunes PID controllers over HTTP, in a browser and on the command line" \
      org.opencontainers.image.licenses="MIT" \
      org.opencontainers.image.version="$VERSION" \
      org.opencontainers.image.source="$SOURCE"
USER 10001
VOLUME /var/lib/tunewright
EXPOSE 8080
# The network in here is the container's own: who reaches it is decided by what is published. TUNEWRIGHT_AUTH=keys asks for more.
ENV TUNEWRIGHT_LISTEN=0.0.0.0:8080 TUNEWRIGHT_ALLOW_ANONYMOUS=true TUNEWRIGHT_STORE=sqlite:/var/lib/tunewright/jobs.db
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["/opt/tunewright/bin/tunewright", "health"]
ENTRYPOINT ["/opt/tunewright/bin/tunewright"]
CMD ["serve"]
