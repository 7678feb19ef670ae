"""FBX files (text, version 7.4) made by hand, for tests."""


def fbx(
    points=(0, 0, 0, 400, 0, 0, 400, 0, -400, 0, 0, -400),
    polygons=(0, 1, 2, -4),
    axes=(1, 1, 2, 1, 0, 1),
    unit=1.0,
    model="",
    objects="",
    connections="",
    kind="Mesh",
):
    """A mesh, as a floor of 4 m by 4 m by default; ``axes`` are up, front and right, each with its sign."""
    named = ("UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign", "CoordAxis", "CoordAxisSign")
    settings = "\n".join(f'P: "{n}", "int", "Integer", "",{v}' for n, v in zip(named, axes, strict=True))
    return f"""; FBX 7.4.0 project file
FBXHeaderExtension:  {{
    FBXHeaderVersion: 1003
    FBXVersion: 7400
    Creator: "a {{test"
}}
GlobalSettings:  {{
    Version: 1000
    Properties70:  {{
        {settings}
        P: "UnitScaleFactor", "double", "Number", "",{unit}
    }}
}}
Objects:  {{
    Geometry: 1000, "Geometry::floor", "{kind}" {{
        Vertices: *{len(points)} {{
            a: {",".join(str(each) for each in points)}
        }}
        PolygonVertexIndex: *{len(polygons)} {{
            a: {",".join(str(each) for each in polygons)}
        }}
        GeometryVersion: 124
    }}
    Model: 2000, "Model::floor", "{kind}" {{
        Version: 232
        Properties70:  {{
            {model}
        }}
    }}
    {objects}
}}
Connections:  {{
    C: "OO",2000,0
    C: "OO",1000,2000
    {connections}
}}
"""


def vector(name, x, y, z):
    """A property of a model."""
    return f'P: "{name}", "{name}", "", "A",{x},{y},{z}\n'
