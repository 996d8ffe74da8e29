import "./cusp-app.js";
