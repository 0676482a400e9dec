// First in a module: what `volume_corner_cut.wgsl` needs.
enable clip_distances;
