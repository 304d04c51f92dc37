# CADRefine on Debian, from this folder alone:
#
#   docker build --tag cadrefine .                      # DEBIAN=13 for Debian 13: --build-arg DEBIAN=13
#   docker run --rm --volume "$PWD:/work" cadrefine -np 2 mesh.vtu part.step --output refined.vtu
#
# tests/debian/image carries out these lines without a container engine.
ARG DEBIAN=12

FROM debian:${DEBIAN} AS build
WORKDIR /usr/src/cadrefine
COPY . .
RUN apt-get update && apt-get install --yes --no-install-recommends make
RUN make package

FROM debian:${DEBIAN}
LABEL org.opencontainers.image.title="CADRefine"
LABEL org.opencontainers.image.description="Makes finite element meshes follow their CAD: ParaView with its plugin"
LABEL org.opencontainers.image.version="0.1.0"
LABEL org.opencontainers.image.licenses="BSD-3-Clause"
COPY --from=build /usr/src/cadrefine/build/cadrefine_*.deb /tmp/
RUN apt-get update \
  && apt-get install --yes --no-install-recommends /tmp/cadrefine_*.deb python3-matplotlib python3-meshio python3-h5py \
    python3-scipy xvfb xauth \
  && rm -rf /tmp/cadrefine_*.deb /var/lib/apt/lists/*
RUN useradd --create-home cadrefine && install --directory --owner=cadrefine /work
# As containers are: no network between ranks, more ranks than cores, ranks that may not read each other's memory.
ENV OMPI_MCA_btl=^tcp,ofi
ENV OMPI_MCA_rmaps_base_oversubscribe=1
ENV OMPI_MCA_btl_vader_single_copy_mechanism=none
ENV PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
USER cadrefine
WORKDIR /work
ENTRYPOINT ["cadrefine"]
CMD ["--help"]
