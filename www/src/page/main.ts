import "../element/cusp-app.js";
