//! Layer parameterization: the map from curved rock to flat space.
